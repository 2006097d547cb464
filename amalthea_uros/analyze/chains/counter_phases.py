"""Chains that start in every n-th job of a process, evaluated for all phases of the counter.

A counter represents an external event, such as a message every 20 ms for an executor that runs every millisecond. Which job takes
the message depends on the start of the system, so all phases are evaluated.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from amalthea_uros.analyze.chains.stages import stages
from amalthea_uros.analyze.results import ChainResult, Claim, Quantity, Value
from amalthea_uros.perf.events import EventChain
from amalthea_uros.perf.software import Activity, Call, Process, Task
from amalthea_uros.perf.system import System
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.chains import UnfoldError, sequences, unfold
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.positions import ActivityPosition
from amalthea_uros.timing.dataflow.routes import routes

#: Chains with more phases are not evaluated for all of them.
MAX_PHASES = 1000


class TooManyPhasesError(Exception):
    """A counter has more phases than are evaluated; the text says which."""


def variants(chain: EventChain, context: TimingContext) -> Iterator[System]:
    """The system with each phase of the counter at which a chain starts; nothing if there is no such counter.

    Raises
    ------
    TooManyPhasesError : the counter has more than `MAX_PHASES`.
    """
    position = _counted_start(chain, context)
    if position is None:
        return
    call = position.process.activities[position.outer[0][1]]
    assert isinstance(call, Call)
    assert call.counter is not None
    if call.counter.prescaler > MAX_PHASES:
        raise TooManyPhasesError(
            f"the counter of {call.runnable!r} has {call.counter.prescaler} phases, and at most {MAX_PHASES} are evaluated"
        )
    for offset in range(1, call.counter.prescaler + 1):
        changed = replace(call, counter=replace(call.counter, offset=offset))
        yield _with(context.system, position.process, position.outer[0][1], changed)


def _counted_start(chain: EventChain, context: TimingContext) -> ActivityPosition | None:
    """The position at which a chain starts if a counter lets only some jobs reach it."""
    try:
        events = sequences(unfold(chain, context.system)[0])[0]
        route, *_ = routes([context.system.events_by_name[name] for name in events], context.dataflow)
        first = stages(route, None)[0]
    except (UnfoldError, UnresolvedError):
        return None
    for position in first.positions:
        call = position.process.activities[position.outer[0][1]]
        if isinstance(call, Call) and call.counter is not None and call.counter.prescaler > 1:
            return position
    return None


def _with(system: System, process: Process, index: int, activity: Activity) -> System:
    """The system with one activity of a process replaced."""
    changed = replace(process, activities=(*process.activities[:index], activity, *process.activities[index + 1 :]))
    software = system.software
    if isinstance(changed, Task):
        tasks = tuple(changed if task.name == process.name else task for task in software.tasks)
        return replace(system, software=replace(software, tasks=tasks))
    isrs = tuple(changed if isr.name == process.name else isr for isr in software.isrs)
    return replace(system, software=replace(software, isrs=isrs))


def merged(results: Sequence[ChainResult]) -> ChainResult:
    """The values over all phases: the maximum, the minimum, and the mean of the means."""
    first, *_ = results
    found = []
    for quantity in Quantity:
        values = [result.value(quantity) for result in results]
        finite = [value for value in values if value is not None and value.value is not None]
        if finite and len(finite) == len(values):
            found.append(_over(quantity, finite))
    return replace(first, values=tuple(found), all_values=tuple(found))


def _over(quantity: Quantity, values: Sequence[Value]) -> Value:
    times = [value.value or 0 for value in values]
    time = round(sum(times) / len(times)) if quantity.is_mean else max(times) if quantity.is_upper else min(times)
    is_exact = all(value.claim is Claim.EXACT for value in values)
    one = values[times.index(time)] if time in times else values[0]
    method = f"{one.method}, over all {len(values)} phases"
    return replace(one, value=time, claim=Claim.EXACT if is_exact else Claim.BOUND, method=method)
