"""`amuros import`: an app.yaml from source code."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros._internal.files import is_stream
from amalthea_uros._internal.resources import known_platforms
from amalthea_uros.cli.files import INPUT, OUTPUT_FILE
from amalthea_uros.cli.init import Offer
from amalthea_uros.cli.output import show_findings, show_text
from amalthea_uros.diagnostics import Severity, worst
from amalthea_uros.services.import_code import import_code


@click.command("import")
@click.argument("sources", type=INPUT, nargs=-1, required=True, metavar="SRC...")
@click.option("-o", "--out", "target", type=OUTPUT_FILE, default="app.yaml", show_default=True, help="The file to write.")
@click.option("--board", type=Offer(known_platforms()), help="Controller; default: none, its clock is to be filled in.")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
def command(sources: tuple[Path, ...], target: Path, board: str | None, force: bool) -> None:
    """Write an app.yaml from C or C++ sources that use rclc.

    SRC are files, or folders that are searched for them. What the code cannot tell, such as execution times, becomes TODO in the
    file: no other command accepts the file until these gaps are filled. Needs: pip install 'amuros[code]'.
    """
    result = import_code(sources, target, board=board, force=force)
    show_findings(result.findings)
    if not is_stream(target):
        show_text(result)
    if worst(result.findings) is Severity.ERROR:
        sys.exit(1)
