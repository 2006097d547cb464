"""The command `amuros`: knows the commands by name only, so that starting is fast."""

from __future__ import annotations

import os
import sys
from importlib import import_module

import click

from amalthea_uros import __version__

#: Command -> what `amuros --help` says of it; the module of the same name holds the rest.
COMMANDS = {
    "analyze": "Compute response times, loads, latencies of chains, and verdicts.",
    "build": "Build a model from an app.yaml.",
    "chains": "List the paths from one process to another, with their latencies.",
    "check": "Check models by rules.",
    "diff": "Compare two models by meaning.",
    "explain": "Tell what a rule is about.",
    "fmt": "Rewrite models in canonical form.",
    "info": "Show what is in a model.",
    "rules": "List the rules of check.",
    "schema": "Print the JSON Schema of app.yaml.",
}


class LazyGroup(click.Group):
    """Commands that are imported when they are called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names of the commands."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command."""
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = import_module(f"amalthea_uros.cli.{cmd_name}").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="amuros")
def cli() -> None:
    """AMALTHEA timing models (Eclipse APP4MC .amxmi): read, check and write them.

    Exit codes: 0 fine, 1 findings or differences, 2 wrong use or unreadable input.
    """


def main() -> None:
    """Run the command line; problems with the input are told as findings, never as a traceback."""
    from amalthea_uros.errors import AmurosError

    try:
        cli()
    except AmurosError as error:
        from amalthea_uros.report.terminal import Terminal

        Terminal(sys.stderr).findings(error.findings)
        sys.exit(2)
    except BrokenPipeError:
        # The reader of our output has gone, as in `amuros info m.amxmi | head`; nothing is left to say, also not at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(2)
