"""`amuros analyze`: response times, loads and verdicts."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import click

from amalthea_uros.analyze.assignment import propose_priorities
from amalthea_uros.analyze.explanation import shares
from amalthea_uros.analyze.sensitivity import sensitivity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.perf.software import Communication
from amalthea_uros.pipeline import system_of
from amalthea_uros.report.analysis import Extras, write_explanation, write_json, write_text
from amalthea_uros.report.chains import write_chain
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.timing.settings import Memory, Settings
from amalthea_uros.units import Frequency, parse_frequency


class CoreFrequency(click.ParamType[tuple[str, Frequency]]):
    """`CORE=300MHz`."""

    name = "CORE=FREQUENCY"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, Frequency]:
        """Parse one value."""
        if isinstance(value, tuple):
            return value
        core, _, text = str(value).partition("=")
        try:
            frequency = parse_frequency(text)
        except ValueError as error:
            self.fail(str(error), param, ctx)
        if frequency <= 0:
            self.fail("a frequency has to be greater than zero", param, ctx)
        return core, frequency


class ModeValue(click.ParamType[tuple[str, str]]):
    """`LABEL=VALUE`."""

    name = "LABEL=VALUE"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, str]:
        """Parse one value."""
        if isinstance(value, tuple):
            return value
        label, equals, text = str(value).partition("=")
        if not equals or not label or not text:
            self.fail(f"{value!r} is not of the form LABEL=VALUE", param, ctx)
        return label, text


@click.command("analyze")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="MODEL_OR_YAML...")
@click.option("--frequency", "frequencies", multiple=True, type=CoreFrequency(), help="Clock of a core; may be repeated.")
@click.option("--scale", type=click.FloatRange(min=0, min_open=True), default=1.0, help="Factor on all execution times.")
@click.option(
    "--mode", "modes", multiple=True, type=ModeValue(), help="Value of a mode label that does not change; may be repeated."
)
@click.option(
    "--memory",
    type=click.Choice([str(memory) for memory in Memory]),
    default=str(Memory.NONE),
    help="What accesses to labels cost: nothing, each its latency, or one copy per job.",
)
@click.option("--chain", "chain", metavar="CHAIN", help="Show the values of one event chain, and how they come about.")
@click.option(
    "--communication",
    type=click.Choice(["modelled", *(str(how).lower() for how in Communication)]),
    default="modelled",
    help="When labels are read and written; modelled: as the model says, and implicit where it says nothing.",
)
@click.option(
    "--method", type=click.Choice(["auto", "all"]), default="auto", help="Show the tightest values of chains, or all."
)
@click.option("--any-phase", is_flag=True, help="Let counters at which chains start begin at any of their occurrences.")
@click.option("--explain", metavar="PROCESS", help="Show what the response time of a process is made of.")
@click.option("--sensitivity", "with_sensitivity", is_flag=True, help="Show by how much execution times may grow.")
@click.option("--assign-priorities", "with_priorities", is_flag=True, help="Propose priorities that meet all deadlines.")
@output_option("text", "json")
def command(
    paths: tuple[Path, ...],
    frequencies: tuple[tuple[str, Frequency], ...],
    scale: float,
    modes: tuple[tuple[str, str], ...],
    memory: str,
    chain: str | None,
    communication: str,
    method: str,
    any_phase: bool,
    explain: str | None,
    with_sensitivity: bool,
    with_priorities: bool,
    outputs: tuple[Output, ...],
) -> None:
    """Compute response times, loads and verdicts.

    MODEL_OR_YAML is an app.yaml, or one or several .amxmi files or a folder with some. Each number comes with its method and what it
    claims (exact, or a safe bound), and the assumptions are listed. Exit code 1 if a requirement or deadline is missed.
    """
    system, findings = system_of(paths)
    _check_name("core", [core for core, _ in frequencies], system.cores)
    _check_name("mode label", [label for label, _ in modes], [label.name for label in system.software.mode_labels])
    _check_name("process", [explain] if explain is not None else [], system.processes)
    _check_name("chain", [chain] if chain is not None else [], system.chains)
    settings = Settings(
        dict(frequencies),
        Fraction(str(scale)),
        modes=dict(modes),
        memory=Memory(memory),
        communication=next((how for how in Communication if str(how).lower() == communication), None),
        any_phase=any_phase,
    )
    analysis = analyze_system(system, settings)
    extras = Extras(
        sensitivity=sensitivity(analysis) if with_sensitivity else None,
        proposals=tuple(propose_priorities(analysis)) if with_priorities else None,
    )
    Terminal(sys.stderr).findings((*findings, *analysis.findings))
    for output in outputs:
        if output.format == "json":
            output.write(partial(write_json, analysis, extras, paths, findings, method == "all"))
        elif explain is not None:
            output.write(partial(write_explanation, analysis, explain, shares(analysis, explain)))
        elif chain is not None:
            output.write(partial(write_chain, analysis, chain, method == "all"))
        else:
            output.write(partial(write_text, analysis, extras))
    sys.exit(1 if analysis.misses else 0)


def _check_name(kind: str, names: Iterable[str], known: Iterable[str]) -> None:
    """Refuse a name that the model does not have."""
    existing = list(known)
    for name in names:
        if name not in existing:
            said = f"those of the model are {', '.join(existing)}" if existing else "the model has none"
            raise click.BadParameter(f"there is no {kind} {name!r}; {said}")
