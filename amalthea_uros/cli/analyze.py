"""`amuros analyze`: response times, loads, latencies and verdicts."""

from __future__ import annotations

import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeVar

import click

from amalthea_uros.cli.output import Output, output_option, show_findings, write_outputs
from amalthea_uros.perf.software import Communication
from amalthea_uros.services.analyze import AnalysisResult, ChainDetail, Explanation, analyze_files, chain_detail, explain
from amalthea_uros.timing.settings import Memory, Settings
from amalthea_uros.units import Frequency, parse_frequency

T = TypeVar("T")

_COMMUNICATION = {str(how).lower(): how for how in Communication}


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
    "--all-phases",
    "--any-phase",
    "all_phases",
    is_flag=True,
    help="Evaluate chains for all phases of the counters at which they start.",
)
@click.option("--explain", "process", metavar="PROCESS", help="Show the terms of the response time of a process.")
@click.option(
    "--sensitivity",
    "with_sensitivity",
    is_flag=True,
    help="Show by how much execution times can increase before a limit is missed.",
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
    all_phases: bool,
    process: str | None,
    with_sensitivity: bool,
    with_priorities: bool,
    with_metrics: bool,
    outputs: tuple[Output, ...],
) -> None:
    """Compute response times, loads, end-to-end latencies of event chains, and verdicts.

    MODEL_OR_YAML is an app.yaml, one or more .amxmi files, or a folder of .amxmi files. Each number has a method and a claim
    (exact, or a safe bound), and the assumptions are listed. Exit code 1 if a deadline or requirement is missed.
    """
    settings = Settings(
        dict(frequencies),
        Fraction(str(scale)),
        modes=dict(modes),
        memory=Memory(memory),
        communication=_COMMUNICATION.get(communication),
        all_phases=all_phases,
    )
    result = analyze_files(
        paths,
        settings,
        with_sensitivity=with_sensitivity,
        with_priorities=with_priorities,
        all_methods=method == "all",
        with_metrics=with_metrics,
    )
    as_text = _detail(result, process, chain)
    show_findings(result.findings)
    write_outputs(outputs, result, as_text)
    sys.exit(1 if result.analysis.misses else 0)


def _detail(result: AnalysisResult, process: str | None, chain: str | None) -> Explanation | ChainDetail | None:
    """What is shown instead of all tables."""
    detail = chain_detail(result, chain) if chain is not None else None
    return explain(result, process) if process is not None else detail
