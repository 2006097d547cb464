"""The options for settings that replace or add to the values of a system; commands that compute times share them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import reduce, wraps
from typing import Any, TypeVar

import click

from amalthea_uros.cli.parsed import Parsed
from amalthea_uros.design.changes.change import EXAMPLE, FORM, parse_change
from amalthea_uros.perf.activities import Communication
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.units import Frequency, Time, parse_frequency, parse_time

T = TypeVar("T")

_COMMUNICATION = {str(how).lower(): how for how in Communication}


class AssignmentType(click.ParamType[tuple[str, T]]):
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


_OPTIONS = (
    click.option(
        "--frequency",
        "frequencies",
        multiple=True,
        type=AssignmentType("CORE=FREQUENCY", _clock),
        help="Clock of a core, e.g. Core_0=300MHz; may be repeated.",
    ),
    click.option(
        "--scale",
        type=click.FloatRange(min=0, min_open=True),
        default=1.0,
        show_default=True,
        help="Factor by which all execution times are multiplied.",
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
        type=AssignmentType("CALLBACK=TIME", _phase),
        help="Time at which the first message of a callback is taken, e.g. Message_Factor=5ms; may be repeated.",
    ),
)


def set_option(function: Callable[..., None]) -> Callable[..., None]:
    """Give a command the option that changes values of the system; it receives them as its parameter `changes`."""
    return click.option(
        "--set",
        "changes",
        multiple=True,
        type=Parsed(FORM, parse_change),
        help=f"Change a value of the system first, e.g. {EXAMPLE}; may be repeated.",
    )(function)


def settings_options(function: Callable[..., None]) -> Callable[..., None]:
    """Give a command these options; it receives them as its parameter `settings`."""

    @wraps(function)
    def with_settings(
        *,
        frequencies: tuple[tuple[str, Frequency], ...],
        scale: float,
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
            phases=dict(phases),
        )
        function(settings=settings, **others)

    return reduce(lambda decorated, option: option(decorated), reversed(_OPTIONS), with_settings)


def analysis_options(function: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of all analyses; it receives them as its parameters `settings` and `with_bus`."""

    @wraps(function)
    def with_modes(*, settings: Settings, modes: tuple[tuple[str, str], ...], **others: Any) -> None:
        function(settings=replace(settings, modes=dict(modes)), **others)

    mode = click.option(
        "--mode",
        "modes",
        multiple=True,
        type=AssignmentType("LABEL=VALUE", str),
        help="Constant value of a mode label; may be repeated.",
    )
    bus = click.option("--bus", "with_bus", is_flag=True, help="Also analyze the messages on the CAN bus of an app.yaml.")
    return settings_options(mode(bus(with_modes)))
