"""Chain through controllers whose clocks drift."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import AbstractEventChain, Event, EventChain, HwStructure, ProcessingUnit, StructureType
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.chains import events, parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.graphs import bottom_up
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.timing._moments import Moments
from amalthea_uros.validate.scheduling import cores
from amalthea_uros.validate.wording import listed


def _check(element: EventChain, context: Context) -> Iterator[str]:
    whole: AbstractEventChain = element
    ends = (end for part in bottom_up([whole], parts) for end in (part.stimulus, part.response))
    controllers = (_controller(event, context) for end in ends for event in events(end))
    found = {controller for controller in controllers if controller is not None}
    if len(found) > 1:
        yield f"{element.name!r} goes through {listed(sorted(found, key=name_of))}, which have no common clock"


def _controller(event: Event, context: Context) -> HwStructure | None:
    """Where an event occurs, if it can only do so in one controller."""
    processes = {spot.process for spot in context.once(Moments).of(event)}
    found = {_of(unit) for process in processes for unit in cores(context).get(process, ())}
    return found.pop() if len(found) == 1 else None


def _of(unit: ProcessingUnit) -> HwStructure | None:
    structure = unit.enclosing(HwStructure)
    while structure is not None and structure.structure_type is not StructureType.ECU:
        structure = structure.enclosing(HwStructure)
    return structure


RULE = ModelRule(
    id="TIM-SEPARATE-CLOCKS",
    title="chain through several controllers",
    severity=Severity.INFO,
    target=EventChain,
    check=_check,
    rationale="Their clocks drift, so that offsets between tasks of different controllers mean nothing: the latency is the sum of "
    "what it is within each of them, at their worst phases.",
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
    passes="""
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
  <taskAllocation task="U?type=Task" scheduler="S0?type=TaskScheduler"/>
</mappingModel>
<constraintsModel>
  <eventChains name="C" stimulus="sent?type=ProcessEvent" response="got?type=ProcessEvent"/>
</constraintsModel>
""",
)
