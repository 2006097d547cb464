"""`amuros analyze`: response times, loads, latencies and verdicts."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeVar

import click

from amalthea_uros.analyze.results import EXPLAINED, Quantity
from amalthea_uros.analyze.summary import Schedulable
from amalthea_uros.cli.output import Output, output_option, show_findings, shows_text, write_outputs
from amalthea_uros.perf.activities import Communication
from amalthea_uros.report.closing_line import closing_line
from amalthea_uros.services.analyze import AnalysisResult, analyze_files, chain_detail, explain
from amalthea_uros.timing.settings import Memory, Settings
from amalthea_uros.units import Frequency, Time, parse_frequency, parse_time

T = TypeVar("T")

_COMMUNICATION = {str(how).lower(): how for how in Communication}

#: The closing verdicts that make the exit code 1.
_FAILING = {
    "missed": (Schedulable.NO,),
    "unknown": (Schedulable.NO, Schedulable.UNKNOWN),
    "never": (),
}


class Assignment(click.ParamType[tuple[str, T]]):
    """Text of the form NAME=VALUE; a function that raises a `ValueError` for wrong text converts the value."""

    def __init__(self, form: str, convert: Callable[[str], T]) -> None:
        self.name = form
        self._convert = convert

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, T]:
        """Parse one value."""
        if isinstance(value, tuple):
            return value
        name, _, text = str(value).partition("=")
        if not name or not text:
            self.fail(f"{value!r} is not of the form {self.name}", param, ctx)
        try:
            return name, self._convert(text)
        except ValueError as error:
            self.fail(str(error), param, ctx)


def _clock(text: str) -> Frequency:
    frequency = parse_frequency(text)
    if frequency <= 0:
        raise ValueError("a frequency must be greater than zero")
    return frequency


def _phase(text: str) -> Time:
    phase = parse_time(text)
    if phase < 0:
        raise ValueError("a phase must not be negative")
    return phase


@click.command("analyze")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="MODEL_OR_YAML...")
@click.option(
    "--frequency",
    "frequencies",
    multiple=True,
    type=Assignment("CORE=FREQUENCY", _clock),
    help="Clock of a core, e.g. Core_0=300MHz; may be repeated.",
)
@click.option(
    "--scale",
    type=click.FloatRange(min=0, min_open=True),
    default=1.0,
    show_default=True,
    help="Factor by which all execution times are multiplied.",
)
@click.option(
    "--mode",
    "modes",
    multiple=True,
    type=Assignment("LABEL=VALUE", str),
    help="Constant value of a mode label; may be repeated.",
)
@click.option(
    "--memory",
    type=click.Choice([str(memory) for memory in Memory]),
    default=str(Memory.NONE),
    show_default=True,
    help="Execution time of label accesses: none, latency of each access (explicit), or one copy per job (implicit).",
)
@click.option("--chain", metavar="CHAIN", help="Show all values of one event chain, and the links between its events.")
@click.option(
    "--communication",
    type=click.Choice(["modelled", *_COMMUNICATION]),
    default="modelled",
    show_default=True,
    help="When labels are read and written; modelled: as in the model, implicit by default.",
)
@click.option(
    "--method",
    type=click.Choice(["auto", "all"]),
    default="auto",
    show_default=True,
    help="With --chain: show the tightest values (auto), or those of all methods.",
)
@click.option(
    "--phase",
    "phases",
    multiple=True,
    type=Assignment("CALLBACK=TIME", _phase),
    help="Time at which the first message of a callback is taken, e.g. Message_Factor=5ms; may be repeated.",
)
@click.option(
    "--explain",
    "explained",
    metavar="NAME",
    help="Show what the response time of a process, or a latency of an event chain, consists of.",
)
@click.option(
    "--quantity",
    type=click.Choice([str(quantity) for quantity in EXPLAINED]),
    default=str(Quantity.MAX_REDUCED_REACTION_TIME),
    show_default=True,
    help="With --explain of a chain: the latency.",
)
@click.option(
    "--sensitivity",
    "with_sensitivity",
    is_flag=True,
    help="Show by how much execution times can increase before a limit is missed.",
)
@click.option(
    "--fail-on",
    type=click.Choice(list(_FAILING)),
    default="missed",
    show_default=True,
    help="What makes the exit code 1: something is missed, lost or overloaded; or also unknown; or nothing.",
)
@click.option("--assign-priorities", "with_priorities", is_flag=True, help="Propose priorities that meet all deadlines.")
@click.option("--metrics", "with_metrics", is_flag=True, help="Show minimum, mean and maximum of all metrics of each process.")
@output_option(AnalysisResult)
def command(
    paths: tuple[Path, ...],
    frequencies: tuple[tuple[str, Frequency], ...],
    scale: float,
    modes: tuple[tuple[str, str], ...],
    memory: str,
    chain: str | None,
    communication: str,
    method: str,
    phases: tuple[tuple[str, Time], ...],
    explained: str | None,
    quantity: str,
    with_sensitivity: bool,
    fail_on: str,
    with_priorities: bool,
    with_metrics: bool,
    outputs: tuple[Output, ...],
) -> None:
    """Compute response times, loads, end-to-end latencies of event chains, and verdicts.

    MODEL_OR_YAML is an app.yaml, one or more .amxmi files, or a folder of .amxmi files. Each number has a method and a claim
    (exact, or a safe bound), and the assumptions are listed. The last line says whether all deadlines, requirements and constraints
    are met; the exit code is 1 if one of them is missed, an activation is lost, or a core is overloaded.
    """
    settings = Settings(
        dict(frequencies),
        Fraction(str(scale)),
        modes=dict(modes),
        memory=Memory(memory),
        communication=_COMMUNICATION.get(communication),
        phases=dict(phases),
    )
    result = analyze_files(
        paths,
        settings,
        with_sensitivity=with_sensitivity,
        with_priorities=with_priorities,
        all_methods=method == "all",
        with_metrics=with_metrics,
    )
    if explained is not None:
        result = replace(result, explanation=explain(result, explained, Quantity(quantity)))
    as_text = result.explanation or (chain_detail(result, chain) if chain is not None else None)
    show_findings(result.findings)
    write_outputs(outputs, result, as_text)
    schedulable = result.analysis.summary.schedulable
    if schedulable is not Schedulable.YES and (as_text is not None or not shows_text(outputs)):
        click.echo(closing_line(result.analysis.summary), err=True)
    sys.exit(1 if schedulable in _FAILING[fail_on] else 0)
