"""The commands for AMALTHEA models: `amuros info`, `diff`, `fmt` and `migrate`."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TypeVar

import click

from amalthea_uros._internal.files import is_open_file, is_stream
from amalthea_uros.cli.output import Output, beside_files, output_option, show_findings, show_result, show_text
from amalthea_uros.cli.parameters import INPUT, OUTPUT
from amalthea_uros.cli.patience import working
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.versions import newest_version
from amalthea_uros.services.files import FilesDiff

T = TypeVar("T")


@click.command("info")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL_OR_YAML...")
@click.option("--schema", is_flag=True, help="Also validate each file against the XML schema of its version.")
@output_option("InfoResult")
def info(paths: tuple[Path, ...], schema: bool, outputs: tuple[Output, ...]) -> None:
    """Show the content of a model.

    This includes the version, cores with their clocks and schedulers, tasks and ISRs with their activations, event chains, and the
    number of objects by class. MODEL_OR_YAML is an app.yaml, whose model is built in memory, a file, or a folder with .amxmi files;
    several files make one model.

    Problems found while reading the files are reported on standard error. Exit code 1 if one of them is an error.
    """
    from amalthea_uros.services import info as service

    result = service.info(paths, schema)
    show_result(result, outputs)
    sys.exit(1 if any(finding.severity is Severity.ERROR for finding in result.findings) else 0)


@click.command("diff")
@click.argument("old", type=INPUT)
@click.argument("new", type=INPUT)
@click.option("--impact", "with_impact", is_flag=True, help="Also analyze both models, and compare loads, times and verdicts.")
@output_option("DiffResult")
def diff(old: Path, new: Path, with_impact: bool, outputs: tuple[Output, ...]) -> None:
    """Compare two models by meaning: only what a review has to look at.

    OLD and NEW are files, folders with .amxmi files, or an app.yaml, whose model is built in memory. Objects are compared by their
    names, in whatever file they are; order without meaning, layout, ids and explicit defaults make no difference. Models of different
    AMALTHEA versions are migrated to the newest one in memory. What changes the timing is shown first, in words such as period,
    priority and execution time. Two app.yaml are compared by the values that they state. Exit code 1 if there are differences.
    """
    from amalthea_uros.services import diff as service

    result = service.diff(old, new, with_impact=with_impact)
    show_result(result, outputs)
    sys.exit(1 if result.changes or result.described else 0)


@click.command("fmt")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL...")
@click.option("--check", is_flag=True, help="Write nothing; exit code 1 if a file is not in canonical form.")
@click.option("--diff", "show_diff", is_flag=True, help="Write nothing; show what would change, exit code 1 if anything would.")
def fmt(paths: tuple[Path, ...], check: bool, show_diff: bool) -> None:
    """Rewrite models in canonical form: as Eclipse APP4MC would save them.

    Order, indentation, number formats, explicit defaults and ids follow APP4MC; the AMALTHEA version, comments and unknown
    content are preserved. MODEL is a file or a folder with .amxmi files; with '-', standard input is written to standard output.
    """
    from amalthea_uros.services.format import format_files

    result = format_files(paths, write=not (check or show_diff))
    is_filter = result.is_written and any(map(is_stream, paths))
    show_text(FilesDiff(result.changed, "canonical") if show_diff else result, on_error_stream=is_filter)
    show_findings(result.findings)
    sys.exit(2 if result.findings else 1 if result.changed and not result.is_written else 0)


def _with_progress(items: Sequence[T]) -> Iterator[T]:
    """The items, with the number of those that are finished on a terminal."""
    with working("Migrating", len(items)) as progress:
        for item in items:
            yield item
            progress.step()


@click.command("migrate")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL...")
@click.option(
    "--to", "version", metavar="VERSION", default=newest_version(), show_default=True, help="AMALTHEA version to write."
)
@click.option(
    "-o",
    "--out",
    "target",
    type=OUTPUT,
    metavar="FILE_OR_FOLDER",
    help="What to write: a file for one file, a folder for several; default: beside the old files, with the version in the name.",
)
@click.option("--in-place", is_flag=True, help="Replace the old files.")
@click.option("--force", is_flag=True, help="Overwrite files that exist.")
@click.option("--dry-run", "is_dry_run", is_flag=True, help="Write no model; only report what would be converted.")
@click.option("--compress/--no-compress", default=None, help="Write ZIPs, or plain files; default: as the old files.")
@output_option("MigrationResult")
def migrate(
    paths: tuple[Path, ...],
    version: str,
    target: Path | None,
    in_place: bool,
    force: bool,
    is_dry_run: bool,
    compress: bool | None,
    outputs: tuple[Output, ...],
) -> None:
    """Convert models to another AMALTHEA version, and report what was converted or lost.

    Models of all published versions are read: ITEA 1.1.0 to 1.3.0, and APP4MC 0.7.0 to 3.3.0. They are written in any newer
    version; models newer than 1.2.0 also in older ones back to 1.2.0, unless something would be lost. MODEL is a file or a folder,
    with the folders in it. Files that refer to each other are migrated together: all of them are written, or none.

    Exit code 1 if something is lost, 2 if a file was not migrated.
    """
    from amalthea_uros.services.migrate import migrate_files

    if in_place and target is not None:
        raise click.UsageError("--in-place and -o exclude each other.")
    if target is None and not is_dry_run and any(map(is_open_file, paths)):
        raise click.UsageError("-o names the file for standard input or a pipe; add it, e.g. -o - for standard output.")
    outputs = beside_files(outputs, [("-o", target)])
    result = migrate_files(
        paths,
        version,
        target,
        in_place=in_place,
        force=force,
        compress=compress,
        is_dry_run=is_dry_run,
        track=_with_progress,
    )
    show_result(result, outputs)
    sys.exit(2 if not result.is_complete else 1 if result.lost else 0)
