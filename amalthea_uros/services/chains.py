"""The paths along which data and triggers go, and chains made of them."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros._internal.paths import StrPath, is_description
from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError, UnknownError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.names import require
from amalthea_uros.services.subject import open_system
from amalthea_uros.timing.dataflow.paths import Path as ProcessPath
from amalthea_uros.timing.dataflow.paths import paths, with_chains


@dataclass(frozen=True, slots=True, kw_only=True)
class PathsResult:
    """The paths from one process, runnable or label to another, with their latencies.

    Attributes
    ----------
    model : the file or folder that was read
    paths : the shortest first
    are_all : whether there are no other paths
    chains : the analysis of each path as a chain
    findings : problems found while reading the file
    """

    model: Path
    start: str
    end: str
    paths: tuple[ProcessPath, ...]
    are_all: bool
    chains: tuple[ChainResult, ...]
    findings: tuple[Finding, ...]


def find_paths(model: StrPath, start: str, end: str) -> PathsResult:
    """Find the paths from one process, runnable or label to another, and analyze them.

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : there is no process, runnable or label of a name.
    """
    opened = open_system(model)
    system = opened.system
    require("process, runnable or label", [start, end], {**system.processes, **system.runnables, **system.labels})
    try:
        found = paths(system, start, end)
    except UnknownError as error:
        raise InvalidArgumentError(str(error)) from None
    chains = analyze_system(with_chains(system, found.found)).chains if found.found else ()
    return PathsResult(
        model=Path(model),
        start=start,
        end=end,
        paths=found.found,
        are_all=found.are_all,
        chains=tuple(chains),
        findings=unsuppressed(opened.findings),
    )


def add_path(found: PathsResult, number: int, name: str, target: StrPath) -> None:
    """Write the model with one of the paths as an event chain.

    Parameters
    ----------
    number : of the path, counted from 1
    name : of the chain
    target : the file to write

    Raises
    ------
    InvalidArgumentError : there is no such path, the model has a chain of that name, or it is a description.
    WriteError : the file cannot be written.
    """
    from amalthea_uros.bridge.add_chain import add_chain
    from amalthea_uros.xmi.load import load
    from amalthea_uros.xmi.save import save

    path = chosen_path(found, number)
    if is_description(found.model):
        members = ", ".join(path.processes)
        raise InvalidArgumentError(
            f"a description is not rewritten; add to {found.model}: chains: [{{name: {name}, path: [{members}]}}]"
        )
    model = load(found.model)
    try:
        add_chain(model, *path.chain(name))
    except ValueError as error:
        raise InvalidArgumentError(str(error)) from None
    save(model, target)


def chosen_path(found: PathsResult, number: int) -> ProcessPath:
    """A path by its number.

    Raises
    ------
    InvalidArgumentError : there is no such path.
    """
    if not 1 <= number <= len(found.paths):
        paths_found = "there is only 1 path" if len(found.paths) == 1 else f"there are {len(found.paths)} paths"
        raise InvalidArgumentError(f"no path {number}; {paths_found}")
    return found.paths[number - 1]
