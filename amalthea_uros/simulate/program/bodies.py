"""Programs of processes and of decisions of schedulers."""

from __future__ import annotations

from amalthea_uros.perf.activities import AccessKind
from amalthea_uros.perf.os import Scheduler
from amalthea_uros.perf.software import Isr, Process
from amalthea_uros.simulate.operations import END, NOTE
from amalthea_uros.simulate.program.activities import compile_activity
from amalthea_uros.simulate.program.body import Body
from amalthea_uros.simulate.program.code import Code
from amalthea_uros.simulate.program.hooks import Hooks
from amalthea_uros.simulate.program.obstacles import NotSimulatedError
from amalthea_uros.simulate.program.parts import Parts
from amalthea_uros.timing.basics.notes import UnknownDemandError
from amalthea_uros.timing.basics.settings import Memory
from amalthea_uros.trace.table import EntityKind, EventKind


def process_code(parts: Parts, process: Process, core: str, hooks: Hooks, scheduler: Scheduler | None, in_group: bool) -> Code:
    """The program of a process.

    Parameters
    ----------
    scheduler : whose decision at the end of jobs takes time
    in_group : whether it belongs to a group of tasks, which are preempted at schedule points only

    Raises
    ------
    NotSimulatedError : something in it cannot be simulated.
    """
    try:
        return _process_code(Body(parts, process, core, hooks, in_group), process, scheduler)
    except UnknownDemandError as error:
        raise NotSimulatedError(str(error)) from None


def _process_code(body: Body, process: Process, scheduler: Scheduler | None) -> Code:
    model = body.context.demand_model
    body.require_limited(process.activities)
    entry, exit_ = model.overheads.of_isr(process, body.core) if isinstance(process, Isr) else (None, None)
    copies = model.copies(process, body.core) if model.settings.memory is Memory.IMPLICIT else []
    body.add_all(body.hooks.start)
    body.demand(entry)
    for kind, frame in copies:
        if kind is AccessKind.READ:
            body.frame(frame)
    body.activities(process.activities)
    body.code.mark(body.end)
    for kind, frame in copies:
        if kind is AccessKind.WRITE:
            body.frame(frame)
    body.demand(exit_)
    if scheduler is not None:
        body.number = 0
        for activity in scheduler.overhead:
            compile_activity(body, activity)
    body.add_all(body.hooks.end)
    body.code.add(END)
    return body.code


def decision_code(parts: Parts, scheduler: Scheduler, core: str) -> Code:
    """The program of a decision of a scheduler; raises as `process_code`."""
    body = Body(parts, None, core, Hooks(), in_group=False)
    try:
        body.activities(scheduler.overhead)
    except UnknownDemandError as error:
        raise NotSimulatedError(str(error)) from None
    if parts.is_noted:
        body.code.add(NOTE, int(EventKind.SCHEDULE), parts.resources.entities.number(EntityKind.SCHEDULER, scheduler.name))
    body.code.add(END)
    return body.code
