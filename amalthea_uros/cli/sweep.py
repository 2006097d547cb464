"""`amuros sweep`: analyses for many values."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import click

from amalthea_uros.cli.ends import INTERRUPTED
from amalthea_uros.cli.failing import FAILING, fail_on_option
from amalthea_uros.cli.files import INPUT, OUTPUT_FILE, output_path
from amalthea_uros.cli.output import (
    Output,
    beside_files,
    output_option,
    refuse_input,
    refuse_unwritable,
    show_differences,
    show_findings,
    show_line,
    shows_text,
    write_outputs,
)
from amalthea_uros.cli.parsed import Parsed
from amalthea_uros.cli.settings_options import AssignmentType, analysis_options, set_option
from amalthea_uros.cli.workers_options import workers_options
from amalthea_uros.design.campaign.run import RunOutcome
from amalthea_uros.design.campaign.sweeps import plan_sweep
from amalthea_uros.design.campaign.tables import table_format, write_table
from amalthea_uros.design.changes.change import SWEEP_EXAMPLE, Change, Sweep, parse_sweep
from amalthea_uros.services.sweep import SweepResult, sweep_files
from amalthea_uros.timing.basics.settings import Settings


@click.command("sweep")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL_OR_YAML...")
@click.option(
    "--sweep",
    "sweeps",
    multiple=True,
    required=True,
    type=Parsed("OBJECT.KEY=VALUES", parse_sweep),
    help=f"Analyze with each of several values, a range or a list, e.g. {SWEEP_EXAMPLE}; if repeated, with all combinations.",
)
@click.option("--sample", type=click.IntRange(min=1), metavar="N", help="Analyze only so many combinations, chosen at random.")
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of the random choice.")
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
@click.option(
    "--table",
    type=OUTPUT_FILE,
    metavar="FILE",
    help="Write all results, a row for each variant, to a .csv, .json or .parquet file.",
)
@click.option(
    "--picture",
    "pictures",
    multiple=True,
    type=AssignmentType("OBJECT.QUANTITY=FILE", output_path),
    help="Draw a result over one or two swept values, as SVG; may be repeated.",
)
@workers_options("analyses")
@fail_on_option
@output_option(SweepResult)
def command(
    paths: tuple[Path, ...],
    sweeps: tuple[Sweep, ...],
    sample: int | None,
    seed: int,
    changes: tuple[Change, ...],
    settings: Settings,
    with_bus: bool,
    quantities: tuple[str, ...],
    with_growth: bool,
    table: Path | None,
    pictures: tuple[tuple[str, Path], ...],
    workers: int | None,
    cluster: str | None,
    fail_on: str,
    outputs: tuple[Output, ...],
) -> None:
    """Analyze a system with many values: which periods, offsets, priorities, execution times hold, and what they cost.

    MODEL_OR_YAML is an app.yaml, one or more .amxmi files, or a folder of .amxmi files. Each variant is analysed as by `amuros
    analyze`; the exit code is 1 if one of them is not schedulable (see --fail-on) or fails. With Ctrl-C, the variants that are
    finished are shown, and the exit code is 130. For the best values of all, see `amuros optimize`.
    """
    outputs = beside_files(outputs, [*(("--picture", path) for _, path in pictures), ("--table", table)])
    for path in (*(path for _, path in pictures), *([table] if table is not None else [])):
        refuse_input(path, str(path))
        refuse_unwritable(path)
    if table is not None:
        table_format(table)
    plan = plan_sweep(sweeps, sample, seed)
    is_hidden = not sys.stderr.isatty()
    with click.progressbar(length=len(plan.runs), label="Analyzing", file=sys.stderr, hidden=is_hidden) as bar:

        def advance(_outcome: RunOutcome) -> None:
            bar.update(1)

        result = sweep_files(
            paths,
            plan,
            settings,
            changes,
            with_growth=with_growth,
            with_bus=with_bus,
            workers=workers,
            cluster=cluster,
            on_outcome=advance,
        )
    result = replace(result, shown=quantities)
    for quantity in (*quantities, *(name for name, _ in pictures)):
        result.column(quantity)
    show_findings(result.findings)
    show_differences(result.differences)
    if table is not None:
        write_table(table, result.rows)
    _draw(result, pictures)
    write_outputs(outputs, result)
    if not shows_text(outputs) and len(result.schedulable) < len(plan.runs):
        from amalthea_uros.report.documents.search import sweep_line

        show_line(sweep_line(result))
    sys.exit(_code(result, fail_on))


def _draw(result: SweepResult, pictures: tuple[tuple[str, Path], ...]) -> None:
    if not pictures:
        return
    from amalthea_uros.report.result_pictures import sweep_picture
    from amalthea_uros.xmi.emf.files import FileText, write_text

    for quantity, path in pictures:
        write_text(path, FileText(sweep_picture(result, quantity)))


def _code(result: SweepResult, fail_on: str) -> int:
    if not result.is_complete:
        return INTERRUPTED
    return 1 if result.failed or any(map(result.with_verdict, FAILING[fail_on])) else 0
