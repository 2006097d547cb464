"""Latency constraint without a converted event chain."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventChainLatencyConstraint
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import TASK_EVENTS
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._chains import dropped


def _check(element: EventChainLatencyConstraint, context: Context) -> Iterator[str]:
    name = element.name or ""
    if element.scope is None:
        yield f"the latency constraint {name!r} has no scope"
    elif element.scope.unresolved is not None:
        yield f"the event chain of the latency constraint {name!r} cannot be resolved"
    elif element.scope in context.once(dropped):
        yield f"the latency constraint {name!r} is dropped by am2inc together with its event chain {element.scope.name or ''!r}"


RULE = ModelRule(
    id="INC-LC-SCOPE",
    title="latency constraint without a converted event chain",
    severity=Severity.WARNING,
    target=EventChainLatencyConstraint,
    check=_check,
    rationale="am2inc drops the constraint if it has no scope, if a reference to or within its event chain cannot be resolved, or if "
    "its event chain is dropped. It prints a warning.",
    remedy="Set the scope of the constraint, and correct its event chain if am2inc drops it.",
    fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L"/>
</constraintsModel>
""",
    passes=f"""
{TASK_EVENTS}
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L" scope="C?type=EventChain"/>
</constraintsModel>
""",
)
