"""The values that a model leaves open, as a command that states them."""

from __future__ import annotations

from collections.abc import Iterator
from shlex import quote

from amalthea_uros._internal.plural import counted
from amalthea_uros.design.missing_values import MissingValues
from amalthea_uros.report.basics.document import Listing, Section, lines, section
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.services.analyze import AnalysisResult

_HEADING = "To get numbers"
_TOGETHER = "give all files of the model in one command, e.g. amuros analyze software.amxmi hardware.amxmi mapping.amxmi"
_NO_PROCESSES = f"The model has no tasks and no interrupts: add them, or {_TOGETHER}"
_NO_SCHEDULERS = f"No scheduler of the model is responsible for a core: allocate tasks and cores to schedulers, or {_TOGETHER}"


def missing_section(result: AnalysisResult) -> Section:
    """The command to paste; empty if nothing is missing that can be stated."""
    if not result.analysis.processes and any(path.suffix == ".amxmi" for path in result.paths):
        return section(_HEADING, lines(_NO_PROCESSES))
    if result.missing is None:
        return section(_HEADING)
    unallocated = [lines(_NO_SCHEDULERS)] if result.missing.lacks_schedulers else []
    if not result.missing.changes:
        return section(_HEADING, *unallocated)
    number = counted(len(result.missing.gained), "more process")
    said = f"State these values, which are examples; with yours in their place, {number} can have a response time:"
    return section(_HEADING, *unallocated, lines(said), Listing("", [*_command(result, result.missing), *_allocation(result)]))


def _allocation(result: AnalysisResult) -> Iterator[str]:
    """The command that finds cores for tasks that nothing dispatches, if there are schedulers for them."""
    assert result.missing is not None
    if not result.missing.given and any(change.key == "scheduler" for change in result.missing.changes):
        yield "cores on which all deadlines are met are found by:"
        yield f"  amuros optimize {_files(result)} --vary cores"


def _files(result: AnalysisResult) -> str:
    return " ".join(quote(visible(str(path))) for path in result.paths)


def _command(result: AnalysisResult, missing: MissingValues) -> Iterator[str]:
    words = ["amuros analyze", _files(result)]
    words += (f"--set {quote(str(change))}" for change in missing.given)
    stated = [f"--set {quote(str(change))}" for change in missing.changes]
    yield f"  {' '.join(words)} \\"
    for index, option in enumerate(stated, start=1):
        yield f"    {option}" + (" \\" if index < len(stated) else "")
