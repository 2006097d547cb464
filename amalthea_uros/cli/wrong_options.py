"""Options that a command does not have: what to write instead of those that people try, or that had another name."""

from __future__ import annotations

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
#: Names that were those of another option in another command.
_RENAMED = {
    "--baseline": "--empty NAME subtracts the times of an empty object; --baseline of `amuros check` accepts findings",
    "--baseline-from": "--empty-from TRACE names the trace with the empty object",
    "--mode": "--mode-label LABEL=VALUE sets a mode label; --mode of `amuros simulate` chooses values that vary",
    "--platform": "--board NAME chooses the board, as for `amuros init`; files are possible, too",
}


def explained(error: click.NoSuchOption) -> click.UsageError:
    """The error with what to write instead, if that is known."""
    name = error.option_name
    context = error.ctx
    options = set() if context is None else {option for each in context.command.params for option in each.opts}
    instead = _INSTEAD.get(name)
    renamed = _RENAMED.get(name)
    if renamed is not None and renamed.split()[0] in options:
        instead = renamed
    return error if instead is None else click.UsageError(f"No such option {name!r}: {instead}.", context)
