"""The command `amuros export`, also in the form in which chronSUITE calls an importer."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from uuid import uuid4

import click

from amalthea_uros._internal.files import STANDARD_OUTPUT, is_stream
from amalthea_uros._version import __version__
from amalthea_uros.cli.output import show_findings
from amalthea_uros.cli.parameters import INPUT, OUTPUT_FILE
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import AmurosError
from amalthea_uros.inchron.facts import VERSION
from amalthea_uros.inchron.ids import NAMESPACE
from amalthea_uros.report.basics.display import DISPLAY

#: How an importer ends: wrong command line, no output (am2inc, Options.cpp and Application.cpp).
_WRONG_USE, _NO_OUTPUT = 1, 2

_FLAG = "--importer"


class _ExportCommand(click.Command):
    """An importer ends with another code after a wrong command line."""

    def make_context(self, info_name: str | None, args: list[str], *rest: Any, **extra: Any) -> click.Context:
        """Parse the command line."""
        is_importer = _FLAG in args
        try:
            return super().make_context(info_name, args, *rest, **extra)
        except click.UsageError as error:
            if not is_importer:
                raise
            error.show()
            sys.exit(_WRONG_USE)


def _show_version(context: click.Context, _parameter: click.Parameter, value: bool) -> None:
    """Print what chronSUITE asks an importer for: the version of the metamodel that it writes, and that it merges files."""
    if value:
        click.echo(f"amuros {__version__}\nversion: {VERSION}\ncapabilities: +multi")
        context.exit()


def _install(context: click.Context, _parameter: click.Parameter, value: bool) -> None:
    """Register amuros in the settings of chronSUITE."""
    if value:
        from amalthea_uros.services.importer_registration import register

        path = register(Path(sys.argv[0]).resolve())
        click.echo(f"amuros is the importer of AMALTHEA models of chronSUITE now ({path})")
        context.exit()


@click.command("export", cls=_ExportCommand)
@click.argument("paths", nargs=-1, required=True, type=INPUT, metavar="MODEL_OR_YAML...")
@click.option(
    "-o",
    "--out",
    "--output",
    "target",
    type=OUTPUT_FILE,
    help="The file to write: project.iprx, or model.amxmi for a project; default: standard output.",
)
@click.option(
    "--importer",
    "is_importer",
    is_flag=True,
    help="Behave as chronSUITE expects an importer to: messages, exit codes, --version.",
)
@click.option(
    "--install",
    "-i",
    is_flag=True,
    expose_value=False,
    is_eager=True,
    callback=_install,
    help="Make amuros the importer of AMALTHEA models in the settings of chronSUITE.",
)
@click.option(
    "--version",
    "-V",
    is_flag=True,
    expose_value=False,
    is_eager=True,
    callback=_show_version,
    help="Show the version of what is written.",
)
@click.option("--stable-from-value", metavar="TEXT", help="Let the ids of objects depend on a text.")
@click.option("--stable-from-hash", is_flag=True, help="Let them depend on the content of the files.")
@click.option("--no-stable", is_flag=True, help="Let them be random.")
@click.option(
    "-m", "--mapping", type=OUTPUT_FILE, metavar="FILE", help="Also write which object of the model became which one."
)
@click.option("--no-memory-accesses", is_flag=True, help="Leave out memories, caches, interconnects and ports.")
@click.option(
    "--like-am2inc",
    "is_imitation",
    is_flag=True,
    help="Also write what am2inc writes wrongly as it does, to compare a project with one that it made.",
)
@click.option("--stable", is_flag=True, expose_value=False, hidden=True)
@click.option("--relax", is_flag=True, expose_value=False, hidden=True)
@click.option("--pedantic", is_flag=True, expose_value=False, hidden=True)
@click.option("-Q", "--no-output", "is_dry", is_flag=True, hidden=True)
def export(
    paths: tuple[Path, ...],
    target: Path | None,
    is_importer: bool,
    stable_from_value: str | None,
    stable_from_hash: bool,
    no_stable: bool,
    mapping: Path | None,
    no_memory_accesses: bool,
    is_imitation: bool,
    is_dry: bool,
) -> None:
    """Write models or an app.yaml as a project of INCHRON's chronSUITE (.iprx).

    Event chains, limits, executors and conditions are part of it, which INCHRON's importer am2inc leaves out. What a project has no
    place for is reported, and kept in comments that only amuros reads. With a project as MODEL_OR_YAML and -o MODEL.amxmi, the
    project becomes an AMALTHEA model. Several files make one model.

    To have chronSUITE import AMALTHEA models with it, use --install, or configure an importer with the command line 'amuros' and the
    arguments 'export --importer -o %t %f %F'.
    """
    from amalthea_uros.services import export as service
    from amalthea_uros.services.project_ids import hashed, valued

    if is_importer and mapping is not None and (target is None or is_stream(target)):
        click.echo("[amuros] Error: a mapping is between files: write the project to a file, too, by -o", err=True)
        sys.exit(_WRONG_USE)
    ids = NAMESPACE
    if stable_from_value is not None:
        ids = valued(stable_from_value)
    elif stable_from_hash:
        ids = hashed(paths)
    elif no_stable:
        ids = uuid4()
    try:
        result = service.export(
            paths,
            target or STANDARD_OUTPUT,
            ids,
            mapping=mapping,
            with_memories=not no_memory_accesses,
            like_importer=is_imitation,
            write=not is_dry,
        )
    except AmurosError as error:
        if not is_importer:
            raise
        _tell(error.findings)
        sys.exit(_NO_OUTPUT)
    if is_importer:
        _tell(result.findings)
        return
    show_findings(result.findings)


def _tell(findings: Sequence[Finding]) -> None:
    """Messages in the form of am2inc, which chronSUITE shows."""
    for finding in findings:
        if finding.severity is Severity.ERROR or not DISPLAY.get().is_quiet:
            kind = "" if finding.severity is Severity.INFO else f"{str(finding.severity).capitalize()}: "
            where = f" ({finding.location})" if finding.location else ""
            click.echo(f"[amuros] {kind}{finding.message}{where}", err=True)
