"""The programs of decisions of schedulers."""

from __future__ import annotations

from amalthea_uros.perf.os import Scheduler
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.program.body import Body
from amalthea_uros.simulate.program.image import Code, ProgramHooks
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.trace.table import EntityKind, EventKind


def decision_code(resources: Resources, scheduler: Scheduler, core: str) -> Code:
    """The program of a decision of a scheduler; raises as `body.process_code`."""
    body = Body(resources, None, core, ProgramHooks(), in_group=False)
    body.activities(scheduler.overhead)
    if resources.is_noted:
        body.code.add(layout.NOTE, int(EventKind.SCHEDULE), resources.entities.number(EntityKind.SCHEDULER, scheduler.name))
    body.code.add(layout.END)
    return body.code
