"""`amuros sweep`: analyses for many values."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from amalthea_uros.cli.ends import INTERRUPTED
from amalthea_uros.cli.options import (
    FAILING,
    analysis_options,
    fail_on_option,
    paths_argument,
    seed_option,
    set_option,
    sweep_option,
    table_option,
    workers_options,
)
from amalthea_uros.cli.output import Output, checked_outputs, output_option, show_result, write_runs
from amalthea_uros.cli.parameters import assignment, picture_path
from amalthea_uros.cli.patience import working
from amalthea_uros.design.campaign.sweeps import SweepResult, plan_sweep
from amalthea_uros.design.campaign.tables import table_format
from amalthea_uros.design.changes.change import Change, Sweep
from amalthea_uros.services.changed import open_changed
from amalthea_uros.services.files import save_text
from amalthea_uros.services.sweep import sweep_changed
from amalthea_uros.timing.basics.settings import Settings


@click.command("sweep")
@paths_argument
@sweep_option("Analyze", required=True)
@click.option("--sample", type=click.IntRange(min=1), metavar="N", help="Analyze only so many combinations, chosen at random.")
@seed_option("Seed of the random choice.")
@set_option
@analysis_options
@click.option(
    "--quantity",
    "quantities",
    multiple=True,
    metavar="OBJECT.QUANTITY",
    help="Show this result, e.g. Control_Function.worst_case_response_time; may be repeated. Default: the first ones that change.",
)
@click.option("--growth", "with_growth", is_flag=True, help="Also show by what factor all execution times may grow together.")
@table_option("Write all results, a row for each variant, to a .csv, .json or .parquet file.")
@click.option(
    "--picture",
    "pictures",
    multiple=True,
    type=assignment("OBJECT.QUANTITY=FILE", picture_path),
    help="Draw a result over one or two swept values, as SVG; may be repeated.",
)
@workers_options("analyses")
@fail_on_option
@output_option("SweepResult")
def sweep(
    paths: tuple[Path, ...],
    sweeps: tuple[Sweep, ...],
    sample: int | None,
    seed: int,
    changes: tuple[Change, ...],
    settings: Settings,
    with_bus: bool,
    quantities: tuple[str, ...],
    table: Path | None,
    pictures: tuple[tuple[str, Path], ...],
    fail_on: str,
    outputs: tuple[Output, ...],
    **execution: Any,
) -> None:
    """Analyze a system with many values: which periods, offsets, priorities, execution times hold, and what they cost.

    MODEL_OR_YAML is an app.yaml, one or more .amxmi files, or a folder of .amxmi files. Each variant is analysed as by `amuros
    analyze`; the exit code is 1 if one of them is not schedulable (see --fail-on) or fails. With Ctrl-C, the variants that are
    finished are shown, and the exit code is 130. For the best values of all, see `amuros optimize`.
    """
    outputs = checked_outputs(outputs, [*(("--picture", path) for _, path in pictures), ("--table", table)])
    if table is not None:
        table_format(table)
    plan = plan_sweep(sweeps, sample, seed)
    with working("Analyzing", len(plan.runs)) as progress:
        changed = open_changed(paths, settings, changes, with_bus=with_bus)
        result = sweep_changed(changed, plan, on_outcome=progress.step, **execution)
    result = replace(result, shown=quantities)
    for quantity in (*quantities, *(name for name, _ in pictures)):
        result.column(quantity)
    write_runs(table, result)
    if pictures and result.is_complete:
        from amalthea_uros.report.result_pictures import sweep_picture

        for quantity, path in pictures:
            save_text(path, sweep_picture(result, quantity))
    show_result(result, outputs, closing=_closing(result), is_complete=result.is_complete)
    sys.exit(_code(result, fail_on))


def _closing(result: SweepResult) -> str:
    from amalthea_uros.report.documents.search import sweep_line

    return "" if len(result.schedulable) == len(result.plan.runs) else sweep_line(result)


def _code(result: SweepResult, fail_on: str) -> int:
    if not result.is_complete:
        return INTERRUPTED
    return 1 if result.failed or any(map(result.with_verdict, FAILING[fail_on])) else 0
