"""Event that is not converted, or chain with one."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain, Event, EventSet
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._chains import events_read
from amalthea_uros.validate.rules.inchron._events import CONVERTED


def _check(element: Event | AbstractEventChain, context: Context) -> Iterator[str]:
    if isinstance(element, Event) and not isinstance(element, CONVERTED):
        alone = " by itself, only in chains" if isinstance(element, EventSet) else ""
        yield f"the {type(element).__name__} {element.name!r} is not converted{alone}"
    for event in events_read(element) if isinstance(element, AbstractEventChain) else ():
        if not isinstance(event, CONVERTED):
            yield f"the chain {element.name or ''!r} is dropped because of the {type(event).__name__} {event.name!r}"


RULE = ModelRule(
    id="INC-EV-KIND",
    title="event that is not converted, or chain with one",
    severity=Severity.WARNING,
    target=(Event, AbstractEventChain),
    check=_check,
    rationale="Only events of processes, runnables and labels are converted; a chain with another one is dropped, with a warning.",
    remedy="Use events of processes, runnables or labels.",
    fails="""
<eventModel>
  <events xsi:type="am:CustomEvent" name="c"/>
</eventModel>
<constraintsModel>
  <eventChains name="C" stimulus="c?type=CustomEvent" response="c?type=CustomEvent"/>
</constraintsModel>
""",
    passes="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
</eventModel>
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
</constraintsModel>
""",
)
