"""The options that say where many runs, analyses or designs are executed."""

from __future__ import annotations

from collections.abc import Callable

import click


def workers_options(things: str, default: str = "one for each core") -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command these options; it receives them as its parameters `workers` and `cluster`.

    Parameters
    ----------
    things : what is executed, in the plural
    default : how many at the same time without the option
    """

    def decorate(function: Callable[..., None]) -> Callable[..., None]:
        address = "Use the Dask cluster with this scheduler, e.g. tcp://host:8786."
        with_cluster = click.option("--cluster", metavar="ADDRESS", help=address)(function)
        number = f"Number of {things} at the same time; default: {default}."
        return click.option("--jobs", "workers", type=click.IntRange(min=1), help=number)(with_cluster)

    return decorate
