"""`amuros build`: app.yaml -> app.amxmi."""

from __future__ import annotations

from pathlib import Path

import click

from amalthea_uros._internal.files import STANDARD_INPUT, STANDARD_OUTPUT
from amalthea_uros.cli.files import INPUT, OUTPUT
from amalthea_uros.cli.output import Output, beside_files, output_option, show_findings, show_summaries, write_outputs
from amalthea_uros.metamodel.versions import supported_versions, version_key
from amalthea_uros.services.build import BuildResult, build_file
from amalthea_uros.services.settings import project_settings

#: Versions that can be written: older ones lack elements that a generated model needs.
VERSIONS = [version for version in supported_versions() if version_key(version) >= (1, 2)]


@click.command("build")
@click.argument("description", type=INPUT, metavar="APP.YAML")
@click.option("-o", "--out", "target", type=OUTPUT, help="The file to write; default: APP.amxmi beside APP.YAML.")
@click.option(
    "--amalthea",
    "version",
    type=click.Choice(VERSIONS),
    default=VERSIONS[-1],
    show_default=True,
    help="AMALTHEA version to write.",
)
@click.option("--platform", help="Platform to use instead of the one in APP.YAML: a known name or a file.")
@click.option("--force", is_flag=True, help="Without -o: also replace a model that was not built by amuros, or edited since.")
@click.option("--bus", "with_bus", is_flag=True, help="Also write the CAN bus, as a core whose tasks are the messages.")
@click.option("--compress", is_flag=True, help="Write a ZIP, as APP4MC does for big models.")
@output_option(BuildResult)
def command(
    description: Path,
    target: Path | None,
    version: str,
    platform: str | None,
    force: bool,
    with_bus: bool,
    compress: bool,
    outputs: tuple[Output, ...],
) -> None:
    """Build an AMALTHEA model from a description of a micro-ROS application.

    The decisions are shown: the period and priority of each task, the messages on the bus, the start of the middleware and its
    static pools. All errors are reported in one run, with their locations; nothing is written then.
    """
    is_filter = target is None and description == STANDARD_INPUT
    outputs = beside_files(outputs, [("-o", STANDARD_OUTPUT if is_filter else target)])
    result = build_file(description, target, version, platform, compress, force, with_bus=with_bus)
    show_findings(result.findings)
    show_summaries(result.model, project_settings(description).targets)
    write_outputs(outputs, result)
