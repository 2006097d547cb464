"""Calls of runnables, and of those that other processes execute."""

from __future__ import annotations

from typing import TYPE_CHECKING

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Call, SenderReceiverAccess, ServerCall, ServerCallKind, Waiting
from amalthea_uros.perf.distributions import Statistics
from amalthea_uros.perf.events import RunnableChange, RunnableEvent
from amalthea_uros.perf.software import Runnable
from amalthea_uros.simulate.kernel import operations
from amalthea_uros.simulate.kernel.layout import EXECUTION_NUMBER, EXECUTION_SIZE, LOOP_SIZE
from amalthea_uros.simulate.program.image import JumpLabel
from amalthea_uros.timing.jobs.counts import count_of
from amalthea_uros.timing.jobs.executed import MAX_CALL_DEPTH
from amalthea_uros.timing.jobs.server_calls import obstacle

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body


def call(body: Body, activity: Call) -> None:
    """The activities of a runnable, as often as it is called; it starts and ends each time."""
    runnable = _callable(body, activity)
    number = body.number
    again, done = _repeated(body, activity)
    skip = body.tested(runnable.condition) if activity.times is not None else None
    body.add_all(body.hooks.before.get(number, ()))
    _execution(body, runnable)
    body.add_all(body.hooks.after.get(number, ()))
    body.mark(skip)
    if again is not None:
        body.code.add(operations.JUMP, again)
    body.mark(done)


def _callable(body: Body, activity: Call) -> Runnable:
    runnable = body.context.system.runnables.get(activity.runnable)
    if runnable is None:
        raise UnknownError(f"the runnable {activity.runnable!r} is not defined in the model")
    if runnable.name in body.above:
        raise UnknownError(f"the runnable {runnable.name!r} calls itself")
    if len(body.above) > MAX_CALL_DEPTH:
        raise UnknownError(f"calls are nested deeper than {MAX_CALL_DEPTH} levels")
    return runnable


def _repeated(body: Body, activity: Call) -> tuple[JumpLabel | None, JumpLabel | None]:
    """The begin and the end of a loop around what a call stands for, if it stands for several."""
    if activity.times is None:
        return None, None
    least, mean, most = count_of(activity.times)
    record, done = body.resources.image.record(LOOP_SIZE), JumpLabel()
    passes = Statistics(lower=least, average=float(mean), upper=most)
    body.code.add(operations.REPEAT, record, body.resources.count(passes, f"{body.place()} passes"))
    again = body.code.here()
    body.code.add(operations.AGAIN, record, done)
    return again, done


def _execution(body: Body, runnable: Runnable) -> None:
    """One execution, between what reports its start and its end."""
    service = body.resources.services.get(runnable.name, 0)
    site = body.resources.site(runnable.name) if body.parts.is_noted else 0
    measured = _measured(body, runnable.name)
    if site:
        body.code.add(operations.BEGIN_RUNNABLE, site)
    if measured:
        body.code.add(operations.BEGIN_EXECUTION, measured)
    body.observe(RunnableEvent, runnable.name, RunnableChange.START)
    if service:
        body.code.add(operations.SERVE, service)
    outer, body.above = body.above, (*body.above, runnable.name)
    body.activities(runnable.activities)
    body.above = outer
    if service:
        body.code.add(operations.SERVED, service)
    body.observe(RunnableEvent, runnable.name, RunnableChange.TERMINATE)
    if measured:
        body.code.add(operations.END_EXECUTION, measured)
    if site:
        body.code.add(operations.END_RUNNABLE, site)


def _measured(body: Body, runnable: str) -> int:
    """The record of the executions of a runnable in this process, if they are measured, or 0."""
    number = body.parts.watches.measured.get(runnable)
    if number is None:
        return 0
    if runnable not in body.executions:
        body.executions[runnable] = body.resources.image.record(EXECUTION_SIZE, {EXECUTION_NUMBER: number})
    return body.executions[runnable]


def server_call(body: Body, activity: ServerCall) -> None:
    """A request to another process, and waiting for its end."""
    waits = activity.waits and activity.kind is not ServerCallKind.ASYNCHRONOUS
    if not waits:
        check_executing(body, activity)
    elif activity.runnable not in body.resources.executing:
        raise UnknownError(f"it waits for the server runnable {activity.runnable!r}, which no process executes")
    # Where a model does not state it, a client waits actively, as for INCHRON's importer.
    flags = 0 if activity.waiting is Waiting.PASSIVE else operations.ACTIVE
    service = body.resources.services.get(activity.runnable, 0)
    if activity.kind is not ServerCallKind.GET_RESULT and service:
        body.code.add(operations.ASK, service)
    if waits:
        body.code.add(operations.AWAIT, service, flags)


def check_executing(body: Body, activity: ServerCall | SenderReceiverAccess) -> None:
    """Refuse runnables that are to be executed, but that no process executes.

    Raises
    ------
    UnknownError : there is one.
    """
    reason = obstacle(activity, body.resources.executing)
    if reason:
        raise UnknownError(reason)
