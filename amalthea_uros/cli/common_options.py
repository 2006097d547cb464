"""The options that every command has, and `--watch` of those whose input people edit."""

from __future__ import annotations

import sys

import click

from amalthea_uros._internal.files import reading_once
from amalthea_uros.cli.patience import WORK, with_progress
from amalthea_uros.cli.watch import repeat_on_change
from amalthea_uros.report.basics.display import DISPLAY, Colours, Display

#: The commands that can run again and again.
_WATCHING = frozenset({"analyze", "build", "check", "report"})


def with_common_options(command: click.Command) -> click.Command:
    """A command that was just imported, with the options that all have after its own ones."""
    if command.name in WORK and command.callback is not None:
        command.callback = with_progress(command.name, reading_once()(command.callback))
    if command.name in _WATCHING:
        command.params.append(click.Option(["--watch"], is_flag=True, help="Run again whenever an input file changes."))
        command.callback = repeat_on_change(command.callback)
    command.params += [
        click.Option(
            ["-q", "--quiet"],
            is_flag=True,
            expose_value=False,
            callback=_be_quiet,
            help="Show only errors and the closing line of the result.",
        ),
        click.Option(
            ["-v", "--verbose"],
            is_flag=True,
            expose_value=False,
            callback=_show_log,
            help="Show on standard error what is logged: whether machine code is used, and why.",
        ),
        click.Option(
            ["--color"],
            type=click.Choice([str(choice) for choice in Colours]),
            default=str(Colours.AUTO),
            show_default=True,
            expose_value=False,
            callback=_choose_colours,
            is_eager=True,
            help="When text is coloured; auto: on terminals, unless NO_COLOR or FORCE_COLOR says otherwise.",
        ),
    ]
    return command


def _choose_colours(_context: click.Context, _parameter: click.Parameter, value: str) -> None:
    """Begin a new display: this option comes first, whether it is given or not."""
    DISPLAY.set(Display(Colours(value)))


def _be_quiet(_context: click.Context, _parameter: click.Parameter, value: bool) -> None:
    if value:
        DISPLAY.set(Display(DISPLAY.get().colours, is_quiet=True))


def _show_log(_context: click.Context, _parameter: click.Parameter, value: bool) -> None:
    if not value:
        return
    import logging

    handler = logging.StreamHandler(_StandardError())
    logger = logging.getLogger("amalthea_uros")
    logger.handlers, logger.propagate = [handler], False
    logger.setLevel(logging.INFO)


class _StandardError:
    """Standard error as it is when something is written: a line of progress may be in the way."""

    def write(self, text: str) -> int:
        """Write a text."""
        return sys.stderr.write(text)

    def flush(self) -> None:
        """Write what is buffered."""
        sys.stderr.flush()
