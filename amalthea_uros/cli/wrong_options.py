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
    "--svg": "write the option of a picture with a file, e.g. --gantt FILE.svg",
    "--time": "write --duration TIME, e.g. 10min",
    "--trace-file": "write --trace FILE.btf; the suffix says the format",
}
#: Of one command, where another one has the option, or the same under another name.
_OF_OTHERS = {
    ("analyze", "--duration"): "only amuros simulate and report have a duration; an analysis covers all times",
    ("init", "-o"): "write the file alone: amuros init --board BOARD FILE",
    ("analyze", "--list"): "write --keys, or --matching TEXT, for the values that --set can change",
    (
        "optimize",
        "--set",
    ): "write --offer OBJECT.KEY=VALUES, or write the changed file first: amuros analyze MODEL --set ... -o FILE",
    ("optimize", "--sweep"): "write --offer OBJECT.KEY=VALUES",
    ("sweep", "--offer"): "write --sweep OBJECT.KEY=VALUES",
    ("sweep", "--vary"): "write --sweep OBJECT.KEY=VALUES",
}
#: Formats that have no option of their own.
_FORMATS = ("sarif", "junit")
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
    command = error.ctx.command if error.ctx is not None else None
    name, own = error.option_name, "" if command is None else command.name or ""
    instead = _OF_OTHERS.get((own, name)) or _INSTEAD.get(name)
    if instead is None and name.removeprefix("--") in _FORMATS and command is not None:
        instead = _of_format(name.removeprefix("--"), command)
    return error if instead is None else click.UsageError(f"No such option {name!r}: {instead}.", error.ctx)


def _of_format(name: str, command: click.Command) -> str:
    """The advice for a format, which not every command has."""
    output = next((each for each in command.params if each.name == "outputs"), None)
    if name in getattr(getattr(output, "type", None), "names", ()):
        return f"write --output {name}=FILE"
    return f"the results of this command have no such format; amuros check MODEL --output {name}=FILE has the findings"
