"""The commands for descriptions: `amuros init`, `import`, `build`, `generate` and `schema`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros._internal.files import STANDARD_OUTPUT, is_open_file, is_stream
from amalthea_uros._internal.resources import known_platforms, resource_folder
from amalthea_uros.cli.output import (
    Output,
    beside_files,
    output_option,
    show_findings,
    show_result,
    show_summaries,
    show_text,
    write_outputs,
)
from amalthea_uros.cli.parameters import DESCRIPTION, INPUT, MODEL, OUTPUT, Offer
from amalthea_uros.diagnostics import Severity, worst
from amalthea_uros.metamodel.versions import supported_versions, version_key
from amalthea_uros.services.init import DEFAULT_BOARD, catalogue, example_names, init_from_board, init_from_example

#: Versions that can be written: older ones lack elements that a generated model needs.
VERSIONS = [version for version in supported_versions() if version_key(version) >= (1, 2)]

#: Tools that have a form of their own: those of `BuildTarget`.
_TOOLS = ("inchron",)

_ANOTHER_BOARD = "; for another controller omit --board, and set its frequency and cores in the file"
_BOARDS, _EXAMPLES = known_platforms(), example_names()
_description_argument = click.argument("description", type=INPUT, metavar="APP.YAML")
_platform_option = click.option(
    "--board", "platform", help="Board to use instead of the one in APP.YAML: a known name, or a file."
)
_force_option = click.option("--force", is_flag=True, help="Replace a file that exists.")


@click.command("init")
@click.argument("target", type=OUTPUT, default=Path(), metavar="[FILE_OR_FOLDER]")
@click.option(
    "--board", type=Offer(_BOARDS, _ANOTHER_BOARD), help=f"Controller: {', '.join(_BOARDS)}. Default: {DEFAULT_BOARD}."
)
@click.option("--example", type=Offer(_EXAMPLES), help=f"Copy an example: {', '.join(_EXAMPLES)}.")
@click.option("--list", "lists", is_flag=True, help="List the boards and the examples, and write nothing.")
@_force_option
def init(target: Path, board: str | None, example: str | None, lists: bool, force: bool) -> None:
    """Write a commented app.yaml that can be built, checked and analyzed at once.

    Without FILE_OR_FOLDER it becomes app.yaml in the current folder; with '-', it is written to standard output.
    """
    if lists:
        show_text(catalogue())
        return
    if board is not None and example is not None:
        raise click.UsageError("--board and --example exclude each other; an example states its own board")
    if example is not None:
        result = init_from_example(target, example, force=force)
    else:
        result = init_from_board(target, board or DEFAULT_BOARD, force=force)
    if result.path != STANDARD_OUTPUT:
        show_text(result)


@click.command("import")
@click.argument("sources", type=INPUT, nargs=-1, required=True, metavar="SRC...")
@click.option("-o", "--out", "target", type=DESCRIPTION, default="app.yaml", show_default=True, help="The file to write.")
@click.option("--board", type=Offer(_BOARDS), help="Controller; default: none, its clock is to be filled in.")
@_force_option
def import_(sources: tuple[Path, ...], target: Path, board: str | None, force: bool) -> None:
    """Write an app.yaml from C or C++ sources that use rclc, or from a recording of ROS 2.

    SRC are files, or folders that are searched for them; this needs: pip install 'amuros[code]'. Or SRC is the folder of a recording of
    ros2_tracing (CTF), of which the host is described. Values that SRC does not have become TODO in the file: no other command accepts
    the file until these gaps are filled.
    """
    from amalthea_uros.services.import_code import import_code
    from amalthea_uros.services.import_recording import import_recording, is_recording

    if len(sources) == 1 and is_recording(sources[0]):
        if board is not None:
            raise click.UsageError("--board is for source code; a recording of ROS 2 is that of the host")
        result = import_recording(sources[0], target, force=force)
    else:
        result = import_code(sources, target, board=board, force=force)
    show_findings(result.findings)
    if not is_stream(target):
        show_text(result)
    if worst(result.findings) is Severity.ERROR:
        sys.exit(1)


@click.command("build")
@_description_argument
@click.option("-o", "--out", "target", type=MODEL, help="The file to write; default: APP.amxmi beside APP.YAML.")
@click.option(
    "--amalthea",
    "version",
    type=click.Choice(VERSIONS),
    default=VERSIONS[-1],
    show_default=True,
    help="AMALTHEA version to write.",
)
@_platform_option
@click.option("--force", is_flag=True, help="Without -o: also replace a model that was not built by amuros, or edited since.")
@click.option("--bus", "with_bus", is_flag=True, help="Also write the CAN bus, as a core whose tasks are the messages.")
@click.option("--for", "tool", type=click.Choice(_TOOLS), help="Put what its importer leaves out into a form that it converts.")
@click.option("--compress", is_flag=True, help="Write a ZIP, as APP4MC does for big models.")
@output_option("BuildResult")
def build(
    description: Path,
    target: Path | None,
    version: str,
    platform: str | None,
    force: bool,
    with_bus: bool,
    tool: str | None,
    compress: bool,
    outputs: tuple[Output, ...],
) -> None:
    """Build an AMALTHEA model from a description of a micro-ROS application.

    The decisions are shown: the period and priority of each task, the messages on the bus, the start of the middleware and its
    static pools. All errors are reported in one run, with their locations; nothing is written then.
    """
    from amalthea_uros.services.build import build_file
    from amalthea_uros.services.build_targets import BuildTarget
    from amalthea_uros.validate.settings import project_settings

    is_filter = target is None and is_open_file(description)
    outputs = beside_files(outputs, [("-o", STANDARD_OUTPUT if is_filter else target)])
    result = build_file(
        description, target, version, platform, compress, force, with_bus=with_bus, tool=BuildTarget(tool) if tool else None
    )
    show_findings(result.findings)
    show_summaries(result.model, project_settings(description).targets)
    write_outputs(outputs, result)


@click.command("generate")
@_description_argument
@click.option(
    "-o", "--out", "folder", type=click.Path(path_type=Path, file_okay=False), help="Folder to write to; created if needed."
)
@click.option("--check", "meta", type=INPUT, metavar="COLCON.META", help="Write nothing; compare this file with APP.YAML.")
@_platform_option
@click.option("--controller", metavar="NAME", help="Which one, of a robot with several controllers.")
@click.option("--code", is_flag=True, help="Write the C of entities, executors, loops and threads, too.")
@click.option("--reconnect", is_flag=True, help="Let this code create everything anew when the agent comes back.")
@click.option("--stamps", is_flag=True, help="Let this code send a CAN frame where a callback starts and where it ends.")
@click.option("--force", is_flag=True, help="Also replace files that amuros generate did not write.")
@output_option("GenerateResult")
def generate(
    description: Path,
    folder: Path | None,
    meta: Path | None,
    platform: str | None,
    controller: str | None,
    code: bool,
    reconnect: bool,
    stamps: bool,
    force: bool,
    outputs: tuple[Output, ...],
) -> None:
    """Write build options for the firmware: the smallest static pools that hold.

    Files: colcon.meta, or zenoh_options.cmake, and amuros_limits.h, with which the compiler checks the library. With --check, the
    options of a colcon.meta are compared with what APP.YAML needs: too small, larger than necessary, misspelled, without effect.
    Then the exit code is 1 if there are errors or warnings.

    With --code, or --reconnect or --stamps, amuros_app.c has everything of micro-ROS: nodes, entities, executors, loops and threads.
    The application defines what callbacks do. `amuros measure LOG --markers amuros.markers.yml` reads the frames of --stamps.
    """
    from amalthea_uros.services import generate as service

    if (folder is None) == (meta is None):
        raise click.UsageError("give either -o FOLDER, or --check COLCON.META")
    if folder is not None and str(folder) == "-":
        raise click.UsageError("-o needs a folder, as several files are written")
    if meta is not None:
        check = service.check_colcon_meta(description, meta, platform, controller=controller)
        show_result(check, outputs)
        sys.exit(0 if check.is_fine else 1)
    result = service.generate(
        description, folder, platform, force, controller=controller, code=code, reconnect=reconnect, stamps=stamps
    )
    show_result(result, outputs)


@click.command("schema")
def schema() -> None:
    """Print the JSON Schema of app.yaml, for completion and checks in an editor.

    For editors that use yaml-language-server, write it to a file, and start app.yaml with the line
    `# yaml-language-server: $schema=app.schema.json`.
    """
    click.echo((resource_folder("schemas") / "app.schema.json").read_text(encoding="utf-8"), nl=False)
