"""The command `amuros`: knows its commands by name only, so that it starts fast."""

from __future__ import annotations

import errno
import gc
import os
import sys
from importlib import import_module
from io import StringIO
from typing import Any

import click

from amalthea_uros._version import __version__

#: Command -> its line in `amuros --help`; the module with the same name has the rest.
COMMANDS = {
    "analyze": "Compute response times, loads, chain latencies and verdicts.",
    "build": "Build an AMALTHEA model from an app.yaml.",
    "chains": "List the paths from one process to another, with their latencies.",
    "check": "Check models by rules.",
    "diff": "Compare two models by meaning.",
    "explain": "Explain a rule or another finding.",
    "fmt": "Rewrite models in canonical form.",
    "info": "Show the content of a model.",
    "migrate": "Convert models to another AMALTHEA version.",
    "rules": "List the rules of check.",
    "schema": "Print the JSON Schema of app.yaml.",
    "simulate": "Simulate the system, once or for many variants and seeds.",
}


#: How many more objects there are before garbage is collected; usually 700, so that imports alone are scanned dozens of times.
GARBAGE_THRESHOLD = 50_000

#: The exit code that shells give a process that Ctrl-C ended: 128 and the number of the signal.
INTERRUPTED = 130


class LazyGroup(click.Group):
    """Commands that are imported when they are called."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; click itself would end it with 1 after Ctrl-C, the exit code of findings."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            click.echo("interrupted", err=True)
            ctx.exit(INTERRUPTED)

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
    """Build, check and analyze AMALTHEA timing models (Eclipse APP4MC .amxmi).

    Exit codes: 0 success, 1 findings, differences or missed requirements, 2 wrong use or unreadable input.
    """


def run() -> None:
    """The command as a process of its own: it ends at once, because to free a large model object by object takes a fifth of a run."""
    if sys.stderr is None:
        sys.stderr = StringIO()  # closed by the caller, who wants no messages
    gc.set_threshold(GARBAGE_THRESHOLD)
    code = 0
    try:
        main()
    except SystemExit as end:
        if not isinstance(end.code, int):
            raise
        code = end.code
    try:
        for stream in filter(None, (sys.stdout, sys.stderr)):
            stream.flush()
    except OSError as error:
        code = _failed(error)
    os._exit(code)


def _failed(error: OSError) -> int:
    """Say what could not be read or written, by the descriptor, because the stream may be what failed; the exit code."""
    # The reader of our output is gone, as in `amuros info m.amxmi | head`; that needs no words.
    if not isinstance(error, BrokenPipeError):
        what = "the output cannot be written" if error.filename is None else str(error.filename)
        os.write(2, f"amuros: {what}: {error.strerror or error}\n".encode(errors="replace"))
    return 2


def main() -> None:
    """Run the command line; problems with the input are shown as findings, never as a traceback."""
    from amalthea_uros.errors import AmurosError, InvalidArgumentError

    try:
        if sys.stdout is None:
            raise OSError(errno.EBADF, "it is closed")
        cli()
    except AmurosError as error:
        from amalthea_uros.report.terminal import Terminal

        Terminal(sys.stderr).findings(error.findings)
        sys.exit(2)
    except InvalidArgumentError as error:
        click.UsageError(str(error)).show()
        sys.exit(2)
    except OSError as error:
        sys.exit(_failed(error))
