"""Sequence of fewer than two groups."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Process, Runnable, RunnableSequencingConstraint
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import executing
from amalthea_uros.validate.rule import ModelRule


def _check(element: RunnableSequencingConstraint, context: Context) -> Iterator[str]:
    groups = element.runnable_groups
    # A prototype runs nothing, so that nothing can be told from it.
    scope = {process for process in element.process_scope if isinstance(process, Process) and process.unresolved is None}
    if len(groups) < 2:
        yield f"{element.name!r} puts {len(groups)} groups of runnables into an order"
    elif scope and len(scope) == len(set(element.process_scope)):
        inside = sum(any(_is_inside(runnable, scope, context) for runnable in group.runnables) for group in groups)
        if inside < 2:
            yield f"only {inside} of the {len(groups)} groups of {element.name!r} have a runnable that runs in the process scope"


def _is_inside(runnable: Runnable, scope: set[Process], context: Context) -> bool:
    """Whether a runnable runs in the scope, or it is not known where it runs."""
    processes = executing(runnable, context)
    return not processes or not scope.isdisjoint(processes)


RULE = ModelRule(
    id="DOC-ProcessScope",
    title="sequence of fewer than two groups",
    severity=Severity.INFO,
    target=RunnableSequencingConstraint,
    check=_check,
    rationale="It demands nothing: runnables outside of the process scope do not count. "
    "The documentation of APP4MC asks for at least two groups.",
    remedy="Give the constraint two groups of runnables that run in its process scope.",
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
    passes="""
<swModel>
  <runnables name="R"/>
  <runnables name="S"/>
</swModel>
<constraintsModel>
  <runnableSequencingConstraints name="C">
    <runnableGroups runnables="R?type=Runnable"/>
    <runnableGroups runnables="S?type=Runnable"/>
  </runnableSequencingConstraints>
</constraintsModel>
""",
)
