"""Sequencing constraint with fewer than two groups."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Process, Runnable, RunnableSequencingConstraint
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import executing
from amalthea_uros.validate.rule import ModelRule


def _check(element: RunnableSequencingConstraint, context: Context) -> Iterator[str]:
    groups = element.runnable_groups
    # Prototypes are not executed, so a scope with prototypes cannot be evaluated.
    scope = {process for process in element.process_scope if isinstance(process, Process) and process.unresolved is None}
    if len(groups) < 2:
        yield f"{element.name!r} has {counted(len(groups), 'runnable group')}, but needs at least 2"
    elif scope and len(scope) == len(set(element.process_scope)):
        inside = sum(any(_is_inside(runnable, scope, context) for runnable in group.runnables) for group in groups)
        if inside < 2:
            yield f"{element.name!r} has {counted(inside, 'runnable group')} in its process scope, but needs at least 2"


def _is_inside(runnable: Runnable, scope: set[Process], context: Context) -> bool:
    """Whether a runnable runs in the scope, or no process is known to execute it."""
    processes = executing(runnable, context)
    return not processes or not scope.isdisjoint(processes)


RULE = ModelRule(
    id="DOC-ProcessScope",
    title="sequencing constraint with fewer than two groups",
    severity=Severity.INFO,
    target=RunnableSequencingConstraint,
    check=_check,
    rationale="The constraint has no effect; runnables outside the process scope are ignored. The APP4MC documentation "
    "requires at least two groups.",
    remedy="Add runnable groups until at least two have runnables that run in the process scope.",
    fails="""
<swModel>
  <runnables name="R"/>
</swModel>
<constraintsModel>
  <runnableSequencingConstraints name="C">
    <runnableGroups runnables="R?type=Runnable"/>
  </runnableSequencingConstraints>
</constraintsModel>
""",
    edits={
        "</swModel>": """  <runnables name="S"/>
</swModel>""",
        "</runnableSequencingConstraints>": """  <runnableGroups runnables="S?type=Runnable"/>
  </runnableSequencingConstraints>""",
    },
)
