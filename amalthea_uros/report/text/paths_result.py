"""Paths through processes for people."""

from __future__ import annotations

from amalthea_uros.report.wording.chains import latency_cells
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.chains import PathsResult

_COLUMNS = ("min", "reaction", "data age")


def write(result: PathsResult, terminal: Terminal) -> None:
    """Write paths with their numbers and latencies."""
    if not result.paths:
        where = "" if result.are_all else " among those that were examined; there are too many for all"
        terminal.line(f"there is no path from {result.start} to {result.end}{where}")
        return
    rows = []
    for number, (path, chain) in enumerate(zip(result.paths, result.chains, strict=True), start=1):
        first, *others = path.processes
        text = first + "".join(f" -[{', '.join(links)}]-> {process}" for links, process in zip(path.links, others, strict=True))
        rows.append((number, *latency_cells(chain, _COLUMNS), text))
    if not result.are_all:
        terminal.line(f"the first {len(rows)} paths that were found; there may be more, and shorter ones")
    terminal.table(("", *_COLUMNS, "", "path"), rows, right=(0, 1, 2, 3))
