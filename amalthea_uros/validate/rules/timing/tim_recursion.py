"""Runnable that calls itself."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable, RunnableCall
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    calls = context.once(_calls)
    # Who called first whom on the way from this runnable.
    callers: dict[Runnable, Runnable] = {}
    pending = [element]
    while pending:
        caller = pending.pop()
        for called in calls.get(caller, []):
            if called not in callers:
                callers[called] = caller
                pending.append(called)
    if element in callers:
        path = [element, callers[element]]
        while path[-1] is not element:
            path.append(callers[path[-1]])
        yield f"{element.name!r} calls itself: {' -> '.join(runnable.name or '' for runnable in reversed(path))}"


def _calls(context: Context) -> dict[Runnable, list[Runnable]]:
    found: dict[Runnable, list[Runnable]] = {}
    for call in context.all(RunnableCall):
        caller = call.enclosing(Runnable)
        if caller is not None and call.runnable is not None:
            found.setdefault(caller, []).append(call.runnable)
    return found


RULE = ModelRule(
    id="TIM-RECURSION",
    title="runnable that calls itself",
    severity=Severity.ERROR,
    target=Runnable,
    check=_check,
    rationale="Its execution time has no end.",
    remedy="Break the circle of calls.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R"/>
</swModel>
""",
)
