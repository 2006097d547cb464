"""`amuros migrate`: models in another AMALTHEA version."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TypeVar

import click

from amalthea_uros._internal.files import STANDARD_INPUT
from amalthea_uros.cli.files import INPUT, OUTPUT
from amalthea_uros.cli.output import Output, beside_files, output_option, show_findings, write_outputs
from amalthea_uros.services.migrate import TARGETS, MigrationResult, migrate_files

T = TypeVar("T")


def _with_progress(items: Sequence[T]) -> Iterator[T]:
    """The items, with a bar on a terminal if there are several."""
    is_hidden = len(items) < 2 or not sys.stderr.isatty()
    with click.progressbar(items, label="Migrating", file=sys.stderr, hidden=is_hidden) as bar:
        yield from bar


@click.command("migrate")
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL...")
@click.option("--to", "version", metavar="VERSION", default=TARGETS[-1], show_default=True, help="AMALTHEA version to write.")
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
@output_option(MigrationResult)
def command(
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
    if in_place and target is not None:
        raise click.UsageError("--in-place and -o exclude each other.")
    if STANDARD_INPUT in paths and target is None and not is_dry_run:
        raise click.UsageError("-o names the file for standard input; add it, e.g. -o - for standard output.")
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
    show_findings(result.findings)
    write_outputs(outputs, result)
    sys.exit(2 if not result.is_complete else 1 if result.lost else 0)
