"""Unsupported event set in an event chain."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain, Event, EventChain, EventSet
from amalthea_uros.validate.chains import parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._chains import is_converted, is_parallel


def _check(element: AbstractEventChain, context: Context) -> Iterator[str | Downgraded]:
    name = element.name or ""
    if isinstance(element, EventChain):
        for end, event in (("stimulus", element.stimulus), ("response", element.response)):
            count = _size(event)
            if count == 0:
                yield f"the {end} of the event chain {name!r} is an empty event set"
            elif count > 1:
                yield Downgraded(f"the {end} of the event chain {name!r} is a set of {count} events")
    for segment in [] if is_parallel(element) else parts(element)[1:]:
        count = _size(segment.stimulus)
        if segment.stimulus is not None and count != 1 and is_converted(segment.stimulus):
            size = f"a set of {count} events" if count else "an empty event set"
            yield f"the stimulus of the segment {segment.name or ''!r} of the event chain {name!r} is {size}"


def _size(end: Event | None) -> int:
    """The number of events of a set; an event is a set of one."""
    return len(end.events) if isinstance(end, EventSet) and end.unresolved is None else 1


RULE = ModelRule(
    id="INC-EC-SET",
    title="unsupported event set in an event chain",
    severity=Severity.ERROR,
    target=AbstractEventChain,
    check=_check,
    rationale="am2inc aborts with a failed assertion if the second or a later segment of an event chain starts with a set of no or "
    "several events. It writes a broken event graph if an event chain starts or ends with an empty set. It drops event chains that "
    "start or end with a set of several events, and prints a warning.",
    remedy="Use single events as stimuli and responses.",
    fails="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="a" entity="T?type=Task" eventType="start"/>
  <events xsi:type="am:ProcessEvent" name="b" entity="T?type=Task" eventType="terminate"/>
  <events xsi:type="am:CustomEvent" name="c"/>
  <events xsi:type="am:EventSet" name="set"/>
</eventModel>
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent" response="set?type=EventSet"/>
</constraintsModel>
""",
    edits={
        '  <events xsi:type="am:EventSet" name="set"/>\n': "",
        'response="set?type=EventSet"': 'response="b?type=ProcessEvent"',
    },
)
