"""Chains that pass wires or executors that loop: only an analysis that knows what these do can say how long they take."""

from __future__ import annotations

from amalthea_uros.perf.events import Event, EventChain
from amalthea_uros.timing.dataflow.chains import UnfoldError, sequences, unfold
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.links import Dataflow


def crosses(chain: EventChain, dataflow: Dataflow) -> bool:
    """Whether a chain passes a wire or an executor that loops, so that its latency is that of a way."""
    system = dataflow.system
    if not system.executors and not system.transmissions:
        return False
    try:
        unfolded = unfold(chain, system)[0]
        names = {name for way in sequences(unfolded) for name in way}
    except UnfoldError:
        return False  # the analysis of chains reports it
    return any(
        process in system.transmissions or process in system.executor_of_task
        for name in names & system.events_by_name.keys()
        for process in _processes(system.events_by_name[name], dataflow)
    )


def _processes(event: Event, dataflow: Dataflow) -> set[str]:
    """The processes in which an event can occur."""
    try:
        return {occurrence.process.name for occurrence in dataflow.events.of(event)}
    except UnresolvedError:
        return set()
