"""Options that a command does not have: what to write instead of those that people try, or that had another name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import click

#: Of all commands.
_INSTEAD = {
    "--btf": "write --trace FILE.btf; the suffix says the format",
    "--csv": "write --output csv=FILE where a command has this format, or --table FILE.csv",
    "--format": "write --output FORMAT, or --output FORMAT=FILE",
    "--html": "write amuros report MODEL -o FILE.html",
    "--json": "write --output json, or --output json=FILE",
    "--markdown": "write --output markdown, or --output markdown=FILE",
    "--out-file": "write -o FILE, or --output FORMAT=FILE",
    "--sarif": "write --output sarif=FILE",
    "--junit": "write --output junit=FILE",
    "--svg": "write the option of a picture with a file, e.g. --gantt FILE.svg",
    "--time": "write --duration TIME, e.g. 10min",
    "--trace-file": "write --trace FILE.btf; the suffix says the format",
}
#: Names that are those of another option in another command: what was called so is called so now. The old name still works.
_RENAMED = {
    "--baseline": "--empty",
    "--baseline-from": "--empty-from",
    "--mode": "--mode-label",
    "--platform": "--board",
}


def with_new_names(command: click.Command, words: Sequence[str]) -> list[str]:
    """The words of a command line with the present names of options, and a note on each that had another one."""
    options = {option for each in command.params for option in each.opts}
    renamed = {old: new for old, new in _RENAMED.items() if new in options and old not in options}
    return [_renamed(word, renamed) for word in words]


def _renamed(word: str, renamed: Mapping[str, str]) -> str:
    name, equals, value = word.partition("=")
    if name not in renamed:
        return word
    click.echo(f"note: {name} of this command is now {renamed[name]}", err=True)
    return f"{renamed[name]}{equals}{value}"


def explained(error: click.NoSuchOption) -> click.UsageError:
    """The error with what to write instead, if that is known."""
    instead = _INSTEAD.get(error.option_name)
    return error if instead is None else click.UsageError(f"No such option {error.option_name!r}: {instead}.", error.ctx)
