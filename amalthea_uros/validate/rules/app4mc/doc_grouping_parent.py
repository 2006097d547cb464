"""Invalid scheduler hierarchy."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Scheduler, TaskAllocation, TaskScheduler
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import GROUPING, parent_of, policy


def _check(element: TaskScheduler, context: Context) -> Iterator[str]:
    algorithm, definition = policy(element), element.definition
    needs_parent = algorithm == GROUPING or (definition is not None and definition.requires_parent_scheduler is True)
    if needs_parent and parent_of(element) is None:
        yield f"{element.name!r} has no parent scheduler, but {algorithm} requires one"
    children = context.once(_children)[element]
    if definition is not None and definition.has_exactly_one_child is True and children != 1:
        yield f"{element.name!r} schedules {children} tasks and schedulers, but {algorithm} requires exactly one"


def _children(context: Context) -> Counter[Scheduler | None]:
    tasks = {
        (allocation.task, allocation.scheduler) for allocation in context.all(TaskAllocation) if allocation.task is not None
    }
    children: Counter[Scheduler | None] = Counter(scheduler for _, scheduler in tasks)
    children.update(parent_of(scheduler) for scheduler in context.all(TaskScheduler))
    return children


RULE = ModelRule(
    id="DOC-Grouping-Parent",
    title="invalid scheduler hierarchy",
    severity=Severity.ERROR,
    target=TaskScheduler,
    check=_check,
    rationale="A grouping makes no scheduling decisions itself, and some other algorithms need a parent or exactly one child. "
    "The APP4MC documentation requires a hierarchy that matches the algorithm.",
    remedy="Associate the scheduler with a parent, or change the number of tasks and schedulers below it.",
    fails="""
<osModel>
  <schedulerDefinitions name="Grouping" requiresParentScheduler="true"/>
  <schedulerDefinitions name="OSEK"/>
  <operatingSystems name="OS">
    <taskSchedulers name="group" definition="Grouping?type=SchedulerDefinition"/>
    <taskSchedulers name="main" definition="OSEK?type=SchedulerDefinition"/>
  </operatingSystems>
</osModel>
""",
    edits={
        'definition="Grouping?type=SchedulerDefinition"/>': """definition="Grouping?type=SchedulerDefinition">
      <parentAssociation parent="main?type=TaskScheduler"/>
    </taskSchedulers>""",
    },
)
