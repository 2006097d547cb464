"""The options that several commands share: each is written once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import reduce, wraps
from typing import Any, TypeAlias

import click

from amalthea_uros._internal.csv_cells import RAW_NAMES
from amalthea_uros.cli.key_completion import OfKey
from amalthea_uros.cli.parameters import INPUT, OUTPUT_FILE, POSITIVE, Parsed, PositiveNumber, assignment
from amalthea_uros.design.changes.change import EXAMPLE, FORM, SWEEP_EXAMPLE, parse_change, parse_sweep
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.perf.activities import Communication
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.units import Duration, Frequency, Time, parse_duration, parse_frequency, parse_time

#: Gives the function of a command an option; it receives the value as a parameter.
Decorator: TypeAlias = Callable[[Callable[..., Any]], Callable[..., Any]]

_COMMUNICATION = {str(how).lower(): how for how in Communication}
#: The closing verdicts that make the exit code 1.
FAILING = {
    "missed": (Schedulable.NO,),
    "unknown": (Schedulable.NO, Schedulable.UNKNOWN),
    "never": (),
}


def all_of(options: tuple[Decorator, ...]) -> Decorator:
    """Several options as one, in the order of the help text."""
    return lambda function: reduce(lambda decorated, option: option(decorated), reversed(options), function)


def _clock(text: str) -> Frequency:
    frequency = parse_frequency(text)
    if frequency <= 0:
        raise ValueError("a frequency must be greater than zero")
    return frequency


def not_negative(what: str) -> Callable[[str], Time]:
    """What parses a time that must not be negative."""

    def parse(text: str) -> Time:
        if (time := parse_time(text)) < 0:
            raise ValueError(f"{what} must not be negative")
        return time

    return parse


paths_argument = click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL_OR_YAML...")
set_option = click.option(
    "--set",
    "changes",
    multiple=True,
    type=OfKey(FORM, parse_change),
    help=f"Change a value of the system first, e.g. {EXAMPLE}; may be repeated.",
)
metrics_option = click.option(
    "--metrics", "with_metrics", is_flag=True, help="Show minimum, mean and maximum of all metrics of each process."
)
fail_on_option = click.option(
    "--fail-on",
    type=click.Choice(list(FAILING)),
    default="missed",
    show_default=True,
    help="What makes the exit code 1: something is missed, lost or overloaded; or also unknown; or nothing.",
)


def seed_option(text: str = "Seed of the simulation.") -> Decorator:
    """The seed of random values."""
    return click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help=text)


def duration_option(text: str, default: str | None = None) -> Decorator:
    """The model time of a simulation."""
    return click.option(
        "--duration", type=Parsed("TIME", parse_duration), default=default, show_default=default is not None, help=text
    )


def bus_option(what: str) -> Decorator:
    """Whether something is also done with the messages on the bus."""
    return click.option("--bus", "with_bus", is_flag=True, help=f"Also {what} the messages on the CAN bus of an app.yaml.")


def sweep_option(what: str, *, required: bool = False) -> Decorator:
    """The values that are tried."""
    return click.option(
        "--sweep",
        "sweeps",
        multiple=True,
        required=required,
        type=OfKey("OBJECT.KEY=VALUES", parse_sweep),
        help=f"{what} with each of several values, a range or a list, e.g. {SWEEP_EXAMPLE}; if repeated, with all combinations.",
    )


def table_option(text: str) -> Decorator:
    """The file of a table with a row for each run, and how names are written in it."""
    return all_of((click.option("--table", type=OUTPUT_FILE, metavar="FILE", help=text), raw_names_option))


def _write_raw_names(_context: click.Context, _parameter: click.Parameter, value: bool) -> None:
    RAW_NAMES.set(value)


raw_names_option = click.option(
    "--raw-names",
    is_flag=True,
    expose_value=False,
    callback=_write_raw_names,
    help="Write names to .csv files as they are, also those that a spreadsheet would execute as a formula, such as =1+1.",
)


def workers_options(things: str, default: str = "one for each core") -> Decorator:
    """Where many runs are executed: the parameters `workers` and `cluster`.

    Parameters
    ----------
    things : what is executed, in the plural
    default : how many at the same time without the option
    """
    number = f"Number of {things} at the same time; default: {default}."
    address = "Use the Dask cluster with this scheduler, e.g. tcp://host:8786."
    return all_of(
        (
            click.option("--jobs", "workers", type=click.IntRange(min=1), help=number),
            click.option("--cluster", metavar="ADDRESS", help=address),
        )
    )


_SETTINGS = all_of(
    (
        click.option(
            "--frequency",
            "frequencies",
            multiple=True,
            type=assignment("CORE=FREQUENCY", _clock),
            help="Clock of a core, e.g. Core_0=300MHz; may be repeated.",
        ),
        click.option(
            "--scale",
            type=POSITIVE,
            default=1.0,
            show_default=True,
            help="Factor by which all execution times are multiplied.",
        ),
        click.option(
            "--quantile",
            type=PositiveNumber(below=0.5),
            help="Probability beyond which values of normal distributions without bounds are taken as impossible, e.g. 1e-9.",
        ),
        click.option(
            "--memory",
            type=click.Choice([str(memory) for memory in MemoryModel]),
            default=str(MemoryModel.NONE),
            show_default=True,
            help="Execution time of label accesses: none, latency of each access (explicit), or one copy per job (implicit).",
        ),
        click.option(
            "--communication",
            type=click.Choice(["modelled", *_COMMUNICATION]),
            default="modelled",
            show_default=True,
            help="When labels are read and written; modelled: as in the model, implicit by default.",
        ),
        click.option(
            "--phase",
            "phases",
            multiple=True,
            type=assignment("CALLBACK=TIME", not_negative("a phase")),
            help="Time at which the first message of a callback is taken, e.g. Message_Factor=5ms; may be repeated.",
        ),
    )
)


def settings_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Settings that replace or add to the values of a system: the parameter `settings`."""

    @wraps(function)
    def with_settings(
        *,
        frequencies: tuple[tuple[str, Frequency], ...],
        scale: float,
        quantile: float | None,
        memory: str,
        communication: str,
        phases: tuple[tuple[str, Time], ...],
        **others: Any,
    ) -> None:
        settings = Settings(
            dict(frequencies),
            Fraction(str(scale)),
            memory=MemoryModel(memory),
            communication=_COMMUNICATION.get(communication),
            phases={callback: Duration(time) for callback, time in phases},
            quantile=None if quantile is None else Fraction(str(quantile)),
        )
        function(settings=settings, **others)

    return _SETTINGS(with_settings)


def analysis_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """The options of all analyses: the parameters `settings` and `with_bus`."""

    @wraps(function)
    def with_modes(*, settings: Settings, modes: tuple[tuple[str, str], ...], **others: Any) -> None:
        function(settings=replace(settings, modes=dict(modes)), **others)

    mode = click.option(
        "--mode-label",
        "modes",
        multiple=True,
        type=assignment("LABEL=VALUE", str),
        help="Constant value of a mode label; may be repeated.",
    )
    return settings_options(mode(bus_option("analyze")(with_modes)))
