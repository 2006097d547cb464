"""Problems of a host besides numbers, and what the numbers are based on."""

from __future__ import annotations

from amalthea_uros.analyze.host.results import HostResults
from amalthea_uros.timing.basics.notes import AnalysisNotes

_ASSUMPTIONS = (
    "host: no thread of SCHED_FIFO or SCHED_DEADLINE runs on its computers besides those that are described, and interrupts and the "
    "kernel take no time",
    "host: deciding, polling and taking a message is part of the execution time of the callback",
    "host: callbacks publish at their end, and do not wait for anything",
)


def add_findings(host: HostResults, collected: AnalysisNotes) -> None:
    """Report executors without bounds, and lost messages."""
    for sentence in _ASSUMPTIONS if host.executors else ():
        collected.assume(sentence)
    for executor, result in zip(host.releases.topics.host.executors, host.executors, strict=True):
        if result.reason:
            collected.warning(
                "HST001", f"the response times in {result.name!r} of the host have no bound: {result.reason}", executor
            )
        for callback in executor.callbacks:
            lost = result.handles[callback.name].lost
            if lost is not None:
                collected.warning("HST002", f"{lost.what} of {callback.name!r} can be lost: {lost.sequence}", callback)
