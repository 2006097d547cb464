"""`amuros schema`: the JSON Schema of app.yaml."""

from __future__ import annotations

import click

from amalthea_uros._internal.resources import resource_folder


@click.command("schema")
def command() -> None:
    """Print the JSON Schema of app.yaml, for completion and checks in an editor.

    For editors that use yaml-language-server, write it to a file, and start app.yaml with the line
    `# yaml-language-server: $schema=app.schema.json`.
    """
    click.echo((resource_folder("schemas") / "app.schema.json").read_text(encoding="utf-8"), nl=False)
