"""Chain through controllers whose clocks drift."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.events import EventSet
from amalthea_uros.timing.dataflow.chains import events_of
from amalthea_uros.validate.rule import SystemProblem, SystemRule
from amalthea_uros.validate.system_context import SystemContext
from amalthea_uros.validate.wording import joined


def _check(context: SystemContext) -> Iterator[SystemProblem]:
    for chain in context.system.events.chains:
        controllers = (_controller(event, context) for event in events_of(chain, context.system))
        found = sorted({controller for controller in controllers if controller is not None})
        if len(found) > 1:
            names = joined(map(repr, found))
            yield SystemProblem(chain, f"{chain.name!r} goes through {names}, which have no common clock")


def _controller(name: str, context: SystemContext) -> str | None:
    """The controller in which an event occurs; None if that may be several, or is unknown."""
    event = context.system.events_by_name.get(name)
    if event is None or isinstance(event, EventSet):
        return None
    try:
        processes = {occurrence.process.name for occurrence in context.dataflow.events.of(event)}
    except UnknownError:
        return None
    found = {context.controllers.get(core) for process in processes for core in context.cores.get(process, ())}
    return found.pop() if len(found) == 1 else None


RULE = SystemRule(
    id="TIM-SEPARATE-CLOCKS",
    title="chain through several controllers",
    severity=Severity.INFO,
    check=_check,
    rationale="The clocks of controllers drift, so that offsets between their tasks are not constant: the latency is bounded by the "
    "sum of the latencies within each controller, each at its worst phase.",
    remedy="Expect a bound instead of an exact latency; put the cores into one ECU if they share a clock.",
    fails="""
<eventModel>
  <events xsi:type="am:ProcessEvent" name="sent" eventType="terminate" entity="T?type=Task"/>
  <events xsi:type="am:ProcessEvent" name="got" eventType="start" entity="U?type=Task"/>
</eventModel>
<swModel>
  <tasks name="T"/>
  <tasks name="U"/>
</swModel>
<hwModel>
  <structures name="A" structureType="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core0"/>
  </structures>
  <structures name="B" structureType="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core1"/>
  </structures>
</hwModel>
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S0"/>
    <taskSchedulers name="S1"/>
  </operatingSystems>
</osModel>
<mappingModel>
  <schedulerAllocation scheduler="S0?type=TaskScheduler" responsibility="core0?type=ProcessingUnit"/>
  <schedulerAllocation scheduler="S1?type=TaskScheduler" responsibility="core1?type=ProcessingUnit"/>
  <taskAllocation task="T?type=Task" scheduler="S0?type=TaskScheduler"/>
  <taskAllocation task="U?type=Task" scheduler="S1?type=TaskScheduler"/>
</mappingModel>
<constraintsModel>
  <eventChains name="C" stimulus="sent?type=ProcessEvent" response="got?type=ProcessEvent"/>
</constraintsModel>
""",
    edits={'task="U?type=Task" scheduler="S1?type=TaskScheduler"': 'task="U?type=Task" scheduler="S0?type=TaskScheduler"'},
)
