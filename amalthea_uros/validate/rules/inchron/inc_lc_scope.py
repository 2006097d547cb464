"""Latency constraint without a chain that is converted."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import EventChainLatencyConstraint
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._chains import dropped


def _check(element: EventChainLatencyConstraint, context: Context) -> Iterator[str]:
    if element.scope is None:
        yield f"the constraint {element.name!r} names no chain"
    elif element.scope in context.once(dropped):
        yield f"the constraint {element.name!r} is dropped together with its chain {element.scope.name!r}"


RULE = ModelRule(
    id="INC-LC-SCOPE",
    title="latency constraint without a chain that is converted",
    severity=Severity.WARNING,
    target=EventChainLatencyConstraint,
    check=_check,
    rationale="am2inc drops it, with a warning.",
    remedy="Name the chain, and mend it if it is dropped.",
    fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L"/>
</constraintsModel>
""",
    passes="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
  <events xsi:type="am:CustomEvent" name="c"/>
</eventModel>
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L" scope="C?type=EventChain"/>
</constraintsModel>
""",
)
