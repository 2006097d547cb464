"""The reference of the command line, from the definitions of the commands."""

from __future__ import annotations

from collections.abc import Iterator

import click

from amalthea_uros.cli.main import COMMANDS, cli


def command_lists() -> str:
    """A section for each command: its usage, what it does, its arguments and options."""
    context = click.Context(cli, info_name="amuros")
    return "\n\n".join(_section(name, context) for name in COMMANDS) + "\n"


def _section(name: str, parent: click.Context) -> str:
    command = cli.get_command(parent, name)
    assert command is not None
    context = click.Context(command, info_name=name, parent=parent)
    usage = command.get_usage(context).removeprefix("Usage: ")
    options = [param for param in command.get_params(context) if isinstance(param, click.Option) and not param.hidden]
    rows = ["| option | meaning |", "|---|---|", *(_row(option, context) for option in options)]
    return "\n\n".join([f"## amuros {name}", f"```text\n{usage}\n```", *_help(command), "\n".join(rows)])


def _help(command: click.Command) -> Iterator[str]:
    """The paragraphs of the help, without the marks by which click keeps lines."""
    for paragraph in (command.help or "").replace("\b\n", "").split("\n\n"):
        yield _escaped(" ".join(paragraph.split()))


def _row(option: click.Option, context: click.Context) -> str:
    record = option.get_help_record(context)
    assert record is not None
    spelling, meaning = record
    return f"| {'<br>'.join(f'`{each}`' for each in spelling.split(', '))} | {_escaped(' '.join(meaning.split()))} |"


def _escaped(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*").replace("[", "\\[").replace("_", "\\_")
