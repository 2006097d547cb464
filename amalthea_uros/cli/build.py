"""`amuros build`: app.yaml -> app.amxmi."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

import click

from amalthea_uros.cli.configuration import configuration_of
from amalthea_uros.cli.output import Output, output_option
from amalthea_uros.findings.targets import summary
from amalthea_uros.metamodel.versions import supported_versions, version_key
from amalthea_uros.pipeline import build
from amalthea_uros.report.build import write_json, write_text
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.xmi.save import save

#: Versions that can be written: older ones lack what a generated model is made of.
VERSIONS = [version for version in supported_versions() if version_key(version) >= (1, 2)]


@click.command("build")
@click.argument("description", type=click.Path(path_type=Path), metavar="APP.YAML")
@click.option("-o", "--out", "target", type=click.Path(path_type=Path), help="The file to write; default: beside APP.YAML.")
@click.option("--amalthea", "version", type=click.Choice(VERSIONS), default=VERSIONS[-1], show_default=True)
@click.option("--platform", help="A platform to take instead of the one that APP.YAML names.")
@click.option("--compress", is_flag=True, help="Write a ZIP, as APP4MC does for big models.")
@output_option("text", "json")
def command(
    description: Path, target: Path | None, version: str, platform: str | None, compress: bool, outputs: tuple[Output, ...]
) -> None:
    """Build an AMALTHEA model from a description of a micro-ROS application.

    What was decided is shown: the period and priority of each task, the messages on the bus, the start of the middleware and its
    static pools. Mistakes are told all at once, each with its place, and then nothing is written.
    """
    targets = configuration_of(description).targets
    built = build(description, version, platform)
    path = target or description.with_suffix(".amxmi")
    built.model.documents[0].path = path
    save(built.model, compress=compress)
    terminal = Terminal(sys.stderr)
    terminal.findings(built.assembly.findings)
    if targets:
        from amalthea_uros.checking import target_groups

        for tool, groups in target_groups(built.model, targets).items():
            terminal.line(summary(tool, (group.shown for group in groups)))
    for output in outputs:
        output.write(partial(write_json if output.format == "json" else write_text, built, path, description))
