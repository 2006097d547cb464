"""Recursive runnable."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.graphs import circles
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.execution import waited_for
from amalthea_uros.validate.rule import ModelRule

#: Longer call paths are shortened.
_MOST = 12


def _check(element: Runnable, context: Context) -> Iterator[str]:
    circle = context.once(_circles).get(element)
    if circle is None:
        return
    # The first caller of each runnable in a search from this one.
    first: dict[Runnable, Runnable] = {}
    pending = [element]
    while element not in first:
        caller = pending.pop()
        for called in waited_for(caller, context):
            if called in circle and called not in first:
                first[called] = caller
                pending.append(called)
    path = [element, first[element]]
    while path[-1] is not element:
        path.append(first[path[-1]])
    names = [runnable.name or "" for runnable in reversed(path)]
    if len(names) > _MOST:
        names[_MOST - 2 : -1] = ["..."]
    yield f"{element.name!r} calls itself: {' -> '.join(names)}"


def _circles(context: Context) -> dict[Runnable, set[Runnable]]:
    found = circles(context.all(Runnable), lambda caller: waited_for(caller, context))
    return {runnable: circle for circle in found for runnable in circle}


RULE = ModelRule(
    id="TIM-RECURSION",
    title="recursive runnable",
    severity=Severity.ERROR,
    target=Runnable,
    check=_check,
    rationale="The execution time of the runnable is unbounded.",
    remedy="Break the cycle of calls.",
    fails=runnable_with('<items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>'),
    passes="""
<swModel>
  <runnables name="R"/>
</swModel>
""",
)
