"""Which handle of an executor an activity of its task belongs to, and which one takes a message."""

from __future__ import annotations

from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.executors import Executor, Handle
from amalthea_uros.perf.network import Transmission
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.events import EventLocator
from amalthea_uros.timing.jobs.positions import ActivityPosition


def handle_around(position: ActivityPosition, executor: Executor, events: EventLocator) -> Handle | None:
    """The handle whose callback, or whose taking of a message, an activity is part of; None if it is part of neither."""
    # Several handles can have one callback, such as the services of a lifecycle: the first one stands for it.
    handles = {name: handle for handle in reversed(executor.handles) for name in (handle.take, handle.runnable) if name}
    around = [
        handles[each.activity.runnable]
        for each in events.positions(executor.task)
        if isinstance(each.activity, Call) and each.activity.runnable in handles and each.number <= position.number <= each.last
    ]
    return around[-1] if around else None


def taker(transmission: Transmission, system: System) -> tuple[Executor, Handle] | None:
    """The executor and the handle that a message is for; None if no executor that loops takes it."""
    for executor in system.executors:
        for handle in executor.handles:
            if handle.transmission == transmission.name:
                return executor, handle
    return None
