"""The command `amuros`: knows its commands by name only, so that it starts fast."""

from __future__ import annotations

import errno
import sys
from functools import cache
from importlib import import_module
from keyword import iskeyword
from typing import TYPE_CHECKING, Any

import click

from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros._version import __version__
from amalthea_uros.cli.ends import INTERRUPTED, failed
from amalthea_uros.report.basics.escape import message_line

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

#: Task -> command -> its line in `amuros --help`; the module with the same name has the rest.
_TASKS = {
    "Describe": {
        "init": "Write a commented app.yaml to begin with, or copy an example.",
        "import": "Write an app.yaml from C or C++ sources that use rclc.",
        "build": "Build an AMALTHEA model from an app.yaml.",
        "generate": "Write or check build options of the firmware: colcon.meta.",
    },
    "Check and predict": {
        "check": "Check models by rules.",
        "analyze": "Compute response times, loads, chain latencies and verdicts.",
        "chains": "List the paths between two processes, with their latencies.",
        "simulate": "Simulate the system, once or for many variants and seeds.",
        "report": "Write a report: one HTML page, or a summary in Markdown.",
    },
    "Improve": {
        "sweep": "Analyze the system with many values of its properties.",
        "optimize": "Search for changes that meet all limits, each proved.",
    },
    "Measure": {
        "measure": "Measure the times in a trace: statistics, jitter, histograms.",
        "compare": "Compare predictions with what was measured.",
        "calibrate": "Put measured times into an app.yaml.",
    },
    "Work with models": {
        "info": "Show the content of a model.",
        "diff": "Compare two models by meaning.",
        "fmt": "Rewrite models in canonical form.",
        "migrate": "Convert models to another AMALTHEA version.",
        "export": "Write models as a project of INCHRON's chronSUITE.",
    },
    "Look up and set up": {
        "rules": "List the rules of check.",
        "explain": "Explain a rule or another finding.",
        "schema": "Print the JSON Schema of app.yaml.",
        "lsp": "Run the language server, for editors.",
        "completion": "Print what makes a shell complete commands.",
    },
}
#: Command -> its line.
COMMANDS = {command: line for commands in _TASKS.values() for command, line in commands.items()}

#: The modules with several commands; the others have the name of their command.
_MODULES = {
    command: module
    for module, commands in {
        "analyze": ("chains",),
        "check": ("rules", "explain"),
        "compare": ("calibrate",),
        "descriptions": ("init", "import", "build", "generate", "schema"),
        "models": ("info", "diff", "fmt", "migrate"),
        "shell": ("completion", "lsp"),
    }.items()
    for command in commands
}


class LazyGroup(click.Group):
    """Commands that are imported when they are called."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; click itself would end it with 1 after Ctrl-C, the exit code of findings."""
        try:
            _check_environment()
            return super().invoke(ctx)
        except click.ClickException as given:
            from amalthea_uros.cli.wrong_options import explained

            error = explained(given) if isinstance(given, click.NoSuchOption) else given
            # The list of what can be given for a missing argument has lines of its own, and nothing of the user in it.
            message = error.format_message()
            if message == message_line(message) or isinstance(error, click.MissingParameter):
                raise error from None
            raise click.UsageError(message_line(message), getattr(error, "ctx", ctx)) from None
        except KeyboardInterrupt:
            click.echo("interrupted", err=True)
            ctx.exit(INTERRUPTED)

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The names of the commands."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command."""
        if cmd_name not in COMMANDS:
            if advice := did_you_mean(cmd_name, COMMANDS):
                ctx.fail(f"No such command {cmd_name!r}; {advice}")
            return None
        return _load(cmd_name)

    def resolve_command(self, ctx: click.Context, args: list[str]) -> tuple[str | None, click.Command | None, list[str]]:
        """Find a command, and the present names of its options."""
        from amalthea_uros.cli.wrong_options import with_new_names

        name, command, words = super().resolve_command(ctx, args)
        return name, command, words if command is None else with_new_names(command, words)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """The commands that begin so, without importing them."""
        from click.shell_completion import CompletionItem

        found = [CompletionItem(name, help=line) for name, line in COMMANDS.items() if name.startswith(incomplete)]
        return [*found, *click.Command.shell_complete(self, ctx, incomplete)]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands by task, without importing them."""
        width = max(map(len, COMMANDS))
        for task, commands in _TASKS.items():
            with formatter.section(task):
                formatter.write_dl([(command.ljust(width), line) for command, line in commands.items()])


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="amuros")
def cli() -> None:
    """Build, check and analyze AMALTHEA timing models (Eclipse APP4MC .amxmi).

    Exit codes: 0 success, 1 findings, errors in an app.yaml, differences or missed requirements, 2 wrong use or unreadable input,
    70 a flaw of amuros itself.
    """


@cache
def _load(name: str) -> click.Command:
    from amalthea_uros.cli.common_options import with_common_options

    module = import_module(f"amalthea_uros.cli.{_MODULES.get(name, name)}")
    # The name of `import` is a word of Python.
    command: click.Command = getattr(module, f"{name}_" if iskeyword(name) else name)
    return with_common_options(command)


def _check_environment() -> None:
    try:
        import_module("amalthea_uros._internal.limits")
    except ValueError as error:
        raise click.UsageError(str(error)) from None


def main() -> None:
    """Run the command line; problems with the input are shown as findings, never as a traceback."""
    from amalthea_uros.errors import AmurosError, InvalidArgumentError

    try:
        if sys.stdout is None:
            raise OSError(errno.EBADF, "it is closed")
        cli()
    except AmurosError as error:
        from amalthea_uros.cli.output import show_findings
        from amalthea_uros.findings.catalogue import is_unreadable
        from amalthea_uros.report.wording.findings import findings_text
        from amalthea_uros.report.writers.terminal import Terminal

        terminal = Terminal(sys.stderr)
        show_findings(error.findings)
        if is_unreadable(error.findings):
            sys.exit(2)
        terminal.line(f"{findings_text(error.findings)}; no result is written")
        sys.exit(1)
    except InvalidArgumentError as error:
        from amalthea_uros.report.writers.terminal import Terminal

        Terminal(sys.stderr).line(f"Error: {message_line(str(error))}")
        sys.exit(2)
    except OSError as error:
        raise SystemExit(failed(error)) from error
