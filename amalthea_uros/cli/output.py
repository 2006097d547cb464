"""Where results go: the option `--output FORMAT[=FILE]`, which may be repeated, and findings on standard error."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click
from click.core import ParameterSource
from click.shell_completion import CompletionItem

from amalthea_uros._internal.file_writing import check_writable, result_path
from amalthea_uros._internal.files import STANDARD_ERROR, STANDARD_OUTPUT, FileError, is_standard_output, is_stream, resolved
from amalthea_uros.cli.parameters import INPUT, output_path
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.report import formats
from amalthea_uros.report.basics.display import is_brief
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.files import save_text

if TYPE_CHECKING:
    from amalthea_uros.design.campaign.simulations import CampaignResult
    from amalthea_uros.design.campaign.sweeps import SweepResult
    from amalthea_uros.design.changes.apply import Difference
    from amalthea_uros.metamodel.model import Model


#: Names in `sys`: these streams are written as text, in colour on a terminal.
_STANDARD_STREAMS = {STANDARD_OUTPUT: "stdout", STANDARD_ERROR: "stderr"}


class Output(NamedTuple):
    """One request of the user: a format, and the file for it."""

    format: str
    path: Path

    @property
    def option(self) -> str:
        """How the user gave it."""
        return f"--output {self.format}" + ("" if self.path == STANDARD_OUTPUT else f"={self.path}")


class OutputType(click.ParamType[Output]):
    """`json` or `json=result.json`."""

    name = "FORMAT[=FILE]"

    def __init__(self, names: Iterable[str]) -> None:
        self.names = tuple(names)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Output:
        """Parse one value."""
        if isinstance(value, Output):
            return value
        name, _, path = str(value).partition("=")
        if name not in self.names:
            self.fail(f"unknown format {name!r}, expected one of {', '.join(self.names)}", param, ctx)
        return Output(name, output_path(path) if path else STANDARD_OUTPUT)

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        """The formats that begin so."""
        return [CompletionItem(name) for name in self.names if name.startswith(incomplete)]


def output_option(result: str, *, has_default: bool = True) -> Callable[[Any], Any]:
    """The option for a command: its formats are those that can write its result.

    Parameters
    ----------
    result : the name of the class, which need not be imported to know that
    has_default : whether the first format goes to standard output if none is given
    """
    names = formats.formats_for(result)
    return click.option(
        "--output",
        "outputs",
        type=OutputType(names),
        multiple=True,
        callback=_without_mixture,
        default=(names[0],) if has_default else (),
        show_default=has_default,
        help=f"Format and file of the result: {', '.join(names)}; e.g. json=result.json. Without a file, or with '-', it goes to "
        "standard output. May be repeated.",
    )


def _without_mixture(_context: click.Context, _parameter: click.Parameter, outputs: tuple[Output, ...]) -> tuple[Output, ...]:
    _refuse_mixture((output.option, output.path) for output in outputs)
    return outputs


def beside_files(outputs: tuple[Output, ...], files: Sequence[tuple[str, Path | None]]) -> tuple[Output, ...]:
    """The outputs of a command that also writes files: the text for people goes to standard error if a file is standard output.

    Parameters
    ----------
    files : with the options that name them; None: not given

    Raises
    ------
    UsageError : what the user asked for explicitly would be mixed.
    """
    _refuse_mixture(files)
    if not any(path is not None and is_standard_output(path) for _, path in files):
        return outputs
    if click.get_current_context().get_parameter_source("outputs") is ParameterSource.DEFAULT:
        return tuple(Output(output.format, STANDARD_ERROR) for output in outputs)
    _refuse_mixture([*files, *((output.option, output.path) for output in outputs)])
    return outputs


def _refuse_mixture(uses: Iterable[tuple[str, Path | None]]) -> None:
    """Refuse that several options write to standard output."""
    options = [option for option, path in uses if path is not None and is_standard_output(path)]
    if len(options) > 1:
        raise click.UsageError(f"{' and '.join(options)} both write to standard output; give all but one of them a file.")


def checked_outputs(
    outputs: tuple[Output, ...], files: Iterable[tuple[str, Path | None]], streamed: Iterable[tuple[str, Path]] = ()
) -> tuple[Output, ...]:
    """The outputs beside files, as `beside_files`, each of which can be written: found out before work that may take long.

    Parameters
    ----------
    streamed : files that are opened first, and written while the command works

    Raises
    ------
    UsageError : two options name a file, or it is one of those that the command reads.
    WriteError : a file cannot be written.
    """
    first = list(streamed)
    given = [(option, path) for option, path in files if path is not None]
    outputs = beside_files(outputs, [*first, *given])
    late = [*given, *((output.option, output.path) for output in outputs)]
    for path, number in Counter(path for _, path in (*first, *late)).items():
        if number > 1:
            raise click.UsageError(f"{path} is the file of {number} options; give each its own")
    for option, path in (*first, *late):
        refuse_input(path, option)
    for _, path in late:
        refuse_unwritable(path)
    return outputs


def show_result(
    result: Any, outputs: Sequence[Output], as_text: object | None = None, closing: str = "", *, is_complete: bool = True
) -> None:
    """Write a result, after its findings and what changes did on standard error.

    Parameters
    ----------
    as_text : as for `write_outputs`
    closing : a line for people who do not see it in the text of the result; "" for none
    is_complete : False after an interruption; files are written beside those that are named, which may have whole results
    """
    show_findings(result.findings)
    show_differences(getattr(result, "differences", ()))
    placed = [output._replace(path=result_path(output.path, is_complete=is_complete)) for output in outputs]
    write_outputs(placed, result, as_text)
    for output in placed if not is_complete else ():
        show_partial("result", output.path)
    if closing and not (as_text is None and shows_text(outputs)):
        show_line(closing)


def write_outputs(outputs: Iterable[Output], result: object, as_text: object | None = None) -> None:
    """Write a result in all formats that the user wants.

    Parameters
    ----------
    as_text : what people see instead of the whole result

    Raises
    ------
    WriteError : a file cannot be written.
    UsageError : a file is one of those that the command reads.
    """
    for output in outputs:
        refuse_input(output.path, output.option)
    for output in outputs:
        shown = result if as_text is None or output.format != formats.TEXT else as_text
        stream = _STANDARD_STREAMS.get(output.path)
        if stream is not None:
            formats.write(output.format, shown, getattr(sys, stream))
        else:
            _write_file(output.path, output.format, shown)


def write_runs(table: Path | None, result: CampaignResult | SweepResult) -> None:
    """Write the table of a campaign, if one is wanted; say where it is, if the campaign was interrupted."""
    if table is None:
        return
    from amalthea_uros.design.campaign.tables import write_table

    written = write_table(table, result.rows, is_complete=result.is_complete)
    if written is not None and not result.is_complete:
        show_partial("table", written)


def show_partial(what: str, path: Path) -> None:
    """Say which file has something that is not complete."""
    if not is_stream(path):
        show_line(f"the {what} is not complete; it is in {str(path)!r}")


def refuse_input(path: Path, option: str) -> None:
    """Refuse a file for output that the command reads.

    Parameters
    ----------
    option : how the user gave it

    Raises
    ------
    UsageError : the file would be replaced.
    """
    if not is_stream(path) and resolved(path) in _inputs():
        raise click.UsageError(f"{option} would replace a file that is read.")


def refuse_unwritable(path: Path) -> None:
    """Refuse a file that cannot be written, before work that may take long.

    Raises
    ------
    WriteError : the file cannot be written.
    """
    try:
        check_writable(path)
    except FileError as error:
        from amalthea_uros.xmi.emf.files import not_writable

        raise not_writable(error) from None


def _inputs() -> set[Path]:
    """The files that the present command reads, as its arguments name them, and options for files to read."""
    context = click.get_current_context()
    parameters = (each for each in context.command.params if isinstance(each, click.Argument) or each.type is INPUT)
    values = (context.params.get(each.name) for each in parameters if each.name)
    paths = (path for given in values for path in (given if isinstance(given, tuple) else (given,)))
    return {resolved(path) for path in paths if isinstance(path, Path)}


def shows_text(outputs: Iterable[Output]) -> bool:
    """Whether a result is shown to a person on standard output."""
    return any(output.format == formats.TEXT and output.path == STANDARD_OUTPUT for output in outputs)


def _write_file(path: Path, name: str, result: object) -> None:
    text = StringIO()
    formats.write(name, result, text)
    save_text(path, text.getvalue())


def show_text(result: object, on_error_stream: bool = False) -> None:
    """Show a result to a person."""
    formats.write(formats.TEXT, result, sys.stderr if on_error_stream else sys.stdout)


def show_line(text: str) -> None:
    """Show a line on standard error."""
    Terminal(sys.stderr).line(text)


def show_findings(findings: Iterable[Finding]) -> None:
    """Show findings on standard error; where the user wants to be told little, only errors."""
    quiet = is_brief(sys.stderr)
    Terminal(sys.stderr).findings(finding for finding in findings if not quiet or finding.severity is Severity.ERROR)


def show_differences(differences: Iterable[Difference]) -> None:
    """Show on standard error what changes did."""
    for difference in () if is_brief(sys.stderr) else differences:
        show_line(str(difference))


def show_summaries(model: Model, targets: Sequence[str]) -> None:
    """Show on standard error what target tools make of a model."""
    if targets and not is_brief(sys.stderr):
        from amalthea_uros.findings.targets import summary
        from amalthea_uros.services.check import summaries

        for target, groups in summaries(model, targets).items():
            show_line(summary(target, (group.shown for group in groups)))
