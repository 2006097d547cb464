"""Chains that start in every n-th job of a process, where it is not known in which.

A counter stands for something that comes from outside, such as a message every 20 ms to an executor that runs each millisecond.
Which of the jobs takes it is a matter of chance at the start of the system; here all of them are tried.
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

#: More phases are not tried.
MOST_PHASES = 1000


def variants(chain: EventChain, context: TimingContext) -> Iterator[System]:
    """The system with each phase of the counter at which a chain starts; nothing, if there is no such counter."""
    position = _counted_start(chain, context)
    if position is None:
        return
    call = position.process.activities[position.outer[0][1]]
    assert isinstance(call, Call)
    assert call.counter is not None
    for offset in range(1, call.counter.prescaler + 1):
        changed = replace(call, counter=replace(call.counter, offset=offset))
        yield _with(context.system, position.process, position.outer[0][1], changed)


def _counted_start(chain: EventChain, context: TimingContext) -> ActivityPosition | None:
    """Where a chain starts in some jobs only."""
    try:
        events = sequences(unfold(chain, context.system)[0])[0]
        route, *_ = routes([context.system.events_by_name[name] for name in events], context.dataflow)
        first = stages(route, None)[0]
    except (UnfoldError, UnresolvedError):
        return None
    for position in first.positions:
        call = position.process.activities[position.outer[0][1]]
        if isinstance(call, Call) and call.counter is not None and 1 < call.counter.prescaler <= MOST_PHASES:
            return position
    return None


def _with(system: System, process: Process, index: int, activity: Activity) -> System:
    """A system in which one activity of a process is another one."""
    changed = replace(process, activities=(*process.activities[:index], activity, *process.activities[index + 1 :]))
    software = system.software
    if isinstance(changed, Task):
        tasks = tuple(changed if task.name == process.name else task for task in software.tasks)
        return replace(system, software=replace(software, tasks=tasks))
    isrs = tuple(changed if isr.name == process.name else isr for isr in software.isrs)
    return replace(system, software=replace(software, isrs=isrs))


def merged(results: Sequence[ChainResult]) -> ChainResult:
    """What holds whatever the phase is: the greatest, the least, and the mean of the means."""
    first, *_ = results
    found = []
    for quantity in Quantity:
        values = [result.value(quantity) for result in results]
        known = [value for value in values if value is not None and value.value is not None]
        if known and len(known) == len(values):
            found.append(_over(quantity, known))
    return replace(first, values=tuple(found), everything=tuple(found))


def _over(quantity: Quantity, values: Sequence[Value]) -> Value:
    times = [value.value or 0 for value in values]
    time = round(sum(times) / len(times)) if quantity.is_mean else max(times) if quantity.is_upper else min(times)
    is_exact = all(value.claim is Claim.EXACT for value in values)
    one = values[times.index(time)] if time in times else values[0]
    method = f"{one.method}, over all {len(values)} phases"
    return replace(one, value=time, claim=Claim.EXACT if is_exact else Claim.BOUND, method=method)
