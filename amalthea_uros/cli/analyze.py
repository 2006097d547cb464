"""`amuros analyze`: response times, loads, latencies and verdicts."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import click

from amalthea_uros.analyze.results.chains import EXPLAINED, LatencyQuantity
from amalthea_uros.cli.failing import FAILING, fail_on_option
from amalthea_uros.cli.files import INPUT, OUTPUT_FILE
from amalthea_uros.cli.output import (
    Output,
    beside_files,
    output_option,
    refuse_input,
    show_differences,
    show_findings,
    show_line,
    shows_text,
    write_outputs,
)
from amalthea_uros.cli.settings_options import analysis_options, set_option
from amalthea_uros.design.changes.change import EXAMPLE, Change
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.services.analyze import AnalysisResult, analyze_files, chain_detail
from amalthea_uros.services.changed_model import write_changed
from amalthea_uros.timing.basics.settings import Settings


@click.command("analyze")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL_OR_YAML...")
@set_option
@click.option(
    "-o",
    "--out",
    "target",
    type=OUTPUT_FILE,
    metavar="FILE.amxmi",
    help="With --set: write the changed model; only the changed values differ from the given one.",
)
@analysis_options
@click.option("--chain", metavar="CHAIN", help="Show all values of one event chain, and the links between its events.")
@click.option(
    "--method",
    type=click.Choice(["auto", "all"]),
    default="auto",
    show_default=True,
    help="With --chain: show the tightest values (auto), or those of all methods.",
)
@click.option(
    "--explain",
    "explained",
    metavar="NAME",
    help="Show why a process, a callback or an event chain takes as long as it does, and what would shorten it.",
)
@click.option(
    "--quantity",
    type=click.Choice([str(quantity) for quantity in EXPLAINED]),
    default=str(LatencyQuantity.MAX_REDUCED_REACTION_TIME),
    show_default=True,
    help="With --explain of a chain: the latency.",
)
@click.option(
    "--sensitivity",
    "with_sensitivity",
    is_flag=True,
    help="Show by how much execution times can increase before a limit is missed.",
)
@fail_on_option
@click.option("--assign-priorities", "with_priorities", is_flag=True, help="Propose priorities that meet all deadlines.")
@click.option("--metrics", "with_metrics", is_flag=True, help="Show minimum, mean and maximum of all metrics of each process.")
@output_option(AnalysisResult)
def command(
    paths: tuple[Path, ...],
    changes: tuple[Change, ...],
    target: Path | None,
    settings: Settings,
    with_bus: bool,
    chain: str | None,
    method: str,
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
    are met; the exit code is 1 if one of them is missed, an activation is lost, or a core is overloaded. With --set the system is
    changed first, and a table compares the results before and after.
    """
    outputs = _with_target(outputs, target, changes)
    result = analyze_files(
        paths,
        settings,
        changes=changes,
        with_sensitivity=with_sensitivity,
        with_priorities=with_priorities,
        all_methods=method == "all",
        with_metrics=with_metrics,
        with_bus=with_bus,
    )
    if explained is not None:
        from amalthea_uros.services.explain import explain

        result = replace(result, explanation=explain(result, explained, LatencyQuantity(quantity)))
    as_text = result.explanation or (chain_detail(result, chain) if chain is not None else None)
    if target is not None:
        write_changed(paths, changes, settings, target)
    show_findings(result.findings)
    show_differences(result.differences)
    write_outputs(outputs, result, as_text)
    schedulable = result.analysis.summary.schedulable
    if schedulable is not Schedulable.YES and (as_text is not None or not shows_text(outputs)):
        show_line(closing_line(result.analysis.summary))
    sys.exit(1 if schedulable in FAILING[fail_on] else 0)


def _with_target(outputs: tuple[Output, ...], target: Path | None, changes: Sequence[Change]) -> tuple[Output, ...]:
    """The outputs beside the file of the changed model, which is checked before the analysis."""
    if target is None:
        return outputs
    if not changes:
        raise click.UsageError(f"-o writes a changed model; add a change, e.g. --set {EXAMPLE}")
    refuse_input(target, "-o")
    return beside_files(outputs, [("-o", target)])
