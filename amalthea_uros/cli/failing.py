"""What makes the exit code of an analysis 1."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from amalthea_uros.judge.summary import Schedulable

#: The closing verdicts that make the exit code 1.
FAILING = {
    "missed": (Schedulable.NO,),
    "unknown": (Schedulable.NO, Schedulable.UNKNOWN),
    "never": (),
}


def fail_on_option(function: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the option that says which verdicts make its exit code 1."""
    return click.option(
        "--fail-on",
        type=click.Choice(list(FAILING)),
        default="missed",
        show_default=True,
        help="What makes the exit code 1: something is missed, lost or overloaded; or also unknown; or nothing.",
    )(function)
