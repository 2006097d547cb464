"""`amuros chains`: the ways along which data and triggers go, as chains."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.pipeline import system_of
from amalthea_uros.report.chains import write_paths
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.paths import Path as Way
from amalthea_uros.timing.dataflow.paths import UnknownEndError, paths, with_chains


@click.command("chains")
@click.argument("model", type=click.Path(path_type=Path), metavar="MODEL_OR_YAML")
@click.option("--from", "start", required=True, metavar="NAME", help="Process, runnable or label at which paths start.")
@click.option("--to", "end", required=True, metavar="NAME", help="Process, runnable or label at which they end.")
@click.option("--add", "name", metavar="CHAIN", help="Add a path to the model, as a chain of that name.")
@click.option("--path", "number", type=click.IntRange(min=1), default=1, help="The number of the path to add.")
@click.option("-o", "output", type=click.Path(path_type=Path), metavar="FILE", help="Where to write the model with the chain.")
def command(model: Path, start: str, end: str, name: str | None, number: int, output: Path | None) -> None:
    """List the paths from one process, runnable or label to another, with their latencies.

    A path goes from process to process by the labels and channels that one writes and the next reads, and by triggers. With --add, one
    of them becomes an event chain of the model, which is written to another file. Exit code 1 if there is no path.
    """
    if (name is None) != (output is None):
        raise click.UsageError("--add needs -o FILE, and -o needs --add CHAIN")
    system, _ = system_of([model])
    try:
        found = paths(system, start, end)
    except (UnknownEndError, UnresolvedError) as error:
        raise click.BadParameter(str(error)) from None
    if not found:
        click.echo(f"there is no path from {start} to {end}")
        sys.exit(1)
    if number > len(found):
        raise click.BadParameter(f"there are {len(found)} paths", param_hint="--path")
    write_paths(found, analyze_system(with_chains(system, found)).chains, sys.stdout)
    if name is not None and output is not None:
        _add(model, output, name, number, found[number - 1])


def _add(path: Path, output: Path, name: str, number: int, found: Way) -> None:
    from amalthea_uros.bridge.add_chain import add_chain
    from amalthea_uros.xmi.load import load
    from amalthea_uros.xmi.save import save

    if path.suffix in (".yaml", ".yml"):
        members = ", ".join(found.processes)
        raise click.UsageError(f"write it into the file yourself: chains: [{{name: {name}, path: [{members}]}}]")
    model = load(path)
    try:
        add_chain(model, *found.chain(name))
    except ValueError as error:
        raise click.BadParameter(str(error), param_hint="--add") from None
    save(model, output)
    click.echo(f"path {number} is the chain {name} of {output}")
