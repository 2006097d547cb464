"""`amuros generate`: app.yaml -> colcon.meta and a header for the firmware."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros.cli.files import INPUT
from amalthea_uros.cli.output import Output, output_option, show_findings, write_outputs
from amalthea_uros.services.generate import GenerateResult, check_colcon_meta, generate


@click.command("generate")
@click.argument("description", type=INPUT, metavar="APP.YAML")
@click.option(
    "-o", "--out", "folder", type=click.Path(path_type=Path, file_okay=False), help="Folder to write to; created if needed."
)
@click.option("--check", "meta", type=INPUT, metavar="COLCON.META", help="Write nothing; compare this file with APP.YAML.")
@click.option("--platform", help="Platform to use instead of the one in APP.YAML: a known name or a file.")
@click.option("--force", is_flag=True, help="Also replace files that amuros generate did not write.")
@output_option(GenerateResult)
def command(
    description: Path, folder: Path | None, meta: Path | None, platform: str | None, force: bool, outputs: tuple[Output, ...]
) -> None:
    """Write build options for the firmware: the smallest static pools that hold.

    Files: colcon.meta, or zenoh_options.cmake, and amuros_limits.h, with which the compiler checks the library. With --check, the
    options of a colcon.meta are compared with what APP.YAML needs: too small, larger than necessary, misspelled, without effect.
    Then the exit code is 1 if there are errors or warnings.
    """
    if (folder is None) == (meta is None):
        raise click.UsageError("give either -o FOLDER, or --check COLCON.META")
    if folder is not None and str(folder) == "-":
        raise click.UsageError("-o needs a folder, as several files are written")
    if meta is not None:
        check = check_colcon_meta(description, meta, platform)
        show_findings(check.findings)
        write_outputs(outputs, check)
        sys.exit(0 if check.is_fine else 1)
    result = generate(description, folder, platform, force)
    show_findings(result.findings)
    write_outputs(outputs, result)
