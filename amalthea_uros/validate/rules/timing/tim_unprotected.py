"""Label that several cores write at a time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations_with_replacement

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    DataCoherencyGroup,
    DataStabilityGroup,
    ISRAllocation,
    Label,
    LabelAccess,
    LabelAccessImplementation,
    OperatingSystem,
    OsDataConsistencyMode,
    Process,
    ProcessingUnit,
    Scheduler,
    Semaphore,
    TaskAllocation,
)
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.timing._locks import Writing, writings
from amalthea_uros.validate.scheduling import cores
from amalthea_uros.validate.wording import joined

#: Where processes may run, and what they hold.
_Kind = tuple[frozenset[ProcessingUnit], frozenset[Semaphore]]


def _check(element: Label, context: Context) -> Iterator[str]:
    if element in context.once(_grouped):
        return
    places = cores(context)
    open_to_all = [w for w in writings(context).get(element, ()) if w.process in places and not _is_protected(w, context)]
    # Processes on the same cores with the same semaphores are looked at together.
    kinds: dict[_Kind, set[Process]] = {}
    for writing in open_to_all:
        kinds.setdefault((places[writing.process], writing.held), set()).add(writing.process)
    pairs = combinations_with_replacement(kinds, 2)
    if any(_may_meet(one, other) and len(kinds[one] | kinds[other]) > 1 for one, other in pairs):
        writers = dict.fromkeys(writing.process for writing in open_to_all)
        names = joined(f"{process.name!r} on {_names(places[process])}" for process in writers)
        yield f"{element.name!r} is written by {names}; no semaphore or stated protection keeps them apart"


def _may_meet(one: _Kind, other: _Kind) -> bool:
    """Whether processes may run on different cores without a common semaphore."""
    return len(one[0] | other[0]) > 1 and not one[1] & other[1]


def _names(units: Iterable[ProcessingUnit]) -> str:
    return "/".join(sorted(unit.name or "" for unit in units))


def _grouped(context: Context) -> set[Label]:
    """The labels that have to be consistent, which whoever builds the system has to see to."""
    groups: tuple[DataStabilityGroup | DataCoherencyGroup, ...]
    groups = (*context.all(DataStabilityGroup), *context.all(DataCoherencyGroup))
    return {label for group in groups for label in group.labels}


#: Protection that model elements do not have to show.
_PROTECTED = {"automaticProtection", "customProtection"}
#: The access decides, then the label, then the operating system; these leave it to the next one.
_LEFT_OPEN = {None, "_undefined_", "inherited"}


def _is_protected(writing: Writing, context: Context) -> bool:
    """Whether a protection is stated; copies at the start and end of a job, or at fixed times, are one, too."""
    write, by_access, is_copied = writing.write, None, False
    if isinstance(write, LabelAccess):
        by_access = write.data_stability
        is_copied = write.implementation in (LabelAccessImplementation.IMPLICIT, LabelAccessImplementation.TIMED)
    levels = (by_access, writing.label.data_stability, context.once(_modes).get(writing.process))
    return is_copied or next((level for level in levels if level not in _LEFT_OPEN), None) in _PROTECTED


def _modes(context: Context) -> dict[Process, OsDataConsistencyMode | None]:
    """What the operating system of each process does for consistency."""
    places: list[tuple[Process | None, Scheduler | None]] = [
        (place.task, place.scheduler) for place in context.all(TaskAllocation)
    ]
    places += [(place.isr, place.controller) for place in context.all(ISRAllocation)]
    found = {}
    for process, scheduler in places:
        system = scheduler.enclosing(OperatingSystem) if scheduler is not None else None
        consistency = system.os_data_consistency if system is not None else None
        if process is not None and consistency is not None:
            found[process] = consistency.mode
    return found


RULE = ModelRule(
    id="TIM-UNPROTECTED",
    title="label that several cores may write at a time",
    severity=Severity.WARNING,
    target=Label,
    check=_check,
    rationale="Response times leave out that the writers wait for each other, and chains take each value for one that was written "
    "whole: with a protection the times grow, without one the data may be mixed.",
    remedy="Hold a common semaphore around the accesses, let one process write, or state how the label is protected.",
    fails="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label" access="write"/>
    </activityGraph>
  </tasks>
  <tasks name="U">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label" access="write"/>
    </activityGraph>
  </tasks>
  <labels name="L"/>
</swModel>
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core0"/>
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
""",
    passes="""
<swModel>
  <tasks name="T">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label" access="write"/>
    </activityGraph>
  </tasks>
  <tasks name="U">
    <activityGraph>
      <items xsi:type="am:LabelAccess" data="L?type=Label" access="write"/>
    </activityGraph>
  </tasks>
  <labels name="L" dataStability="automaticProtection"/>
</swModel>
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core0"/>
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
""",
)
