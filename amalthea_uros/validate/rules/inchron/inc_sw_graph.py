"""Runnable without an activity graph."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import metamodel


def _check(element: Runnable, context: Context) -> Iterator[str]:
    if element.activity_graph is None and metamodel(element) >= "3":
        yield f"the runnable {element.name or ''!r} has no activity graph"


RULE = ModelRule(
    id="INC-SW-GRAPH",
    title="runnable without an activity graph",
    severity=Severity.WARNING,
    target=Runnable,
    check=_check,
    rationale="am2inc converts the runnable to an empty function and prints a warning.",
    remedy="Add an activity graph, even if it is empty.",
    fails="""
<swModel>
  <runnables name="R"/>
</swModel>
""",
    edits={
        'name="R"/>': """name="R">
    <activityGraph/>
  </runnables>""",
    },
)
