"""`amuros analyze`: response times, loads and verdicts."""

from __future__ import annotations

import sys
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import click

from amalthea_uros.analyze.settings import Settings
from amalthea_uros.analyze.system import analyze
from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.pipeline import system_of
from amalthea_uros.report.analysis import write_explanation, write_json, write_text
from amalthea_uros.report.terminal import Terminal
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


@click.command("analyze")
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="MODEL_OR_YAML...")
@click.option("--frequency", "frequencies", multiple=True, type=CoreFrequency(), help="Clock of a core; may be repeated.")
@click.option("--scale", type=click.FloatRange(min=0, min_open=True), default=1.0, help="Factor on all execution times.")
@click.option("--explain", metavar="PROCESS", help="Show what the response time of a process is made of.")
@output_option("text", "json")
def command(
    paths: tuple[Path, ...],
    frequencies: tuple[tuple[str, Frequency], ...],
    scale: float,
    explain: str | None,
    outputs: tuple[Output, ...],
) -> None:
    """Compute response times, loads and verdicts.

    MODEL_OR_YAML is an app.yaml, or one or several .amxmi files or a folder with some. Each number comes with its method and what it
    claims (exact, or a safe bound), and the assumptions are listed. Exit code 1 if a requirement or deadline is missed.
    """
    system, findings = system_of(paths)
    unknown = [core for core, _ in frequencies if core not in system.cores]
    if unknown:
        raise click.BadParameter(f"there is no core {unknown[0]!r}; cores are {', '.join(system.cores)}")
    if explain is not None and explain not in system.processes:
        raise click.BadParameter(f"there is no process {explain!r}; processes are {', '.join(system.processes)}")
    analysis = analyze(system, Settings(frequencies=dict(frequencies), scale=Fraction(str(scale))))
    Terminal(sys.stderr).findings((*findings, *analysis.findings))
    for output in outputs:
        if output.format == "json":
            output.write(partial(write_json, analysis, paths, findings))
        elif explain is not None:
            output.write(partial(write_explanation, analysis, explain))
        else:
            output.write(partial(write_text, analysis))
    sys.exit(1 if analysis.misses else 0)
