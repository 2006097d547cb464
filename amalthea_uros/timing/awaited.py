"""Processes that wait for what they send to be acknowledged, besides executors in loops.

A callback in a task of its own, or one that a periodic executor calls, is suspended while it publishes a reliable message, like any
other (micro-ROS/rmw_microxrcedds, src/rmw_publish.c). Its job does not end meanwhile, and afterwards it delays others later than its
activation says, so that neither its response time nor those of processes of lower priority are known.
"""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.network import Transmission, Wait
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.jobs.executed import executed
from amalthea_uros.units import time_text

_WAYS_OUT = "give the executor its loop, or state 'reliable: {waits: false}' if the port does not wait"


def awaited(process: str, system: System, dataflow: Dataflow) -> Iterator[Transmission | Wait]:
    """The messages whose acknowledgements the jobs of a process wait for."""
    sent = [each for each in system.network.transmissions if each.waits]
    if sent:
        fired = {firing.stimulus for firing in dataflow.firings(process)}
        yield from (each for each in sent if not fired.isdisjoint(system.processes[each.name].stimuli))
    if system.network.waits:
        activities = executed(system.processes[process].activities, system)
        called = {activity.runnable for activity in activities if isinstance(activity, Call)}
        yield from (each for each in system.network.waits if each.runnable in called)


def why_suspended(process: str, system: System, dataflow: Dataflow) -> str:
    """Why the jobs of a process take longer than they execute; "" if they do not, or if the analysis of executors bounds it."""
    if process in system.executor_of_task:
        return ""
    for message in awaited(process, system, dataflow):
        most = f" up to {time_text(message.timeout)}" if isinstance(message, Wait) and message.timeout is not None else ""
        return (
            f"it waits{most} for the acknowledgement of {message.topic!r}, for which the analysis has no bound outside an executor "
            f"with a loop; {_WAYS_OUT}"
        )
    return ""
