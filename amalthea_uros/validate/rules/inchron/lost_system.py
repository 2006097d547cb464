"""Parts of the hardware, operating systems, mapping and requirements that am2inc drops, ignores or changes."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    AffinityConstraint,
    DataAgeConstraint,
    DataCoherencyGroup,
    DataStabilityGroup,
    EventChainLatencyConstraint,
    HwAccessElement,
    HwConnection,
    HwDefinition,
    IAnnotatable,
    LabelEvent,
    OperatingSystem,
    PhysicalSectionConstraint,
    PhysicalSectionMapping,
    ProcessEvent,
    Requirement,
    RunnableAllocation,
    RunnableEvent,
    RunnableSequencingConstraint,
    SchedulerAllocation,
    Semaphore,
    Stimulus,
    TimingConstraint,
)
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

_DROPPED = (
    TimingConstraint,
    AffinityConstraint,
    RunnableSequencingConstraint,
    DataAgeConstraint,
    DataCoherencyGroup,
    DataStabilityGroup,
    PhysicalSectionConstraint,
    Requirement,
)


def _check_constraint(element: IAnnotatable, context: Context) -> Iterator[str]:
    if not isinstance(element, EventChainLatencyConstraint):
        yield f"the {type(element).__name__} {name_of(element)!r} is dropped by am2inc"


def _check_event_restriction(element: LabelEvent | ProcessEvent | RunnableEvent, context: Context) -> Iterator[str]:
    if isinstance(element, LabelEvent):
        restriction = None if element.runnable is None else f"the runnable {element.runnable.name or ''!r}"
    else:
        restriction = None if element.processing_unit is None else f"the core {element.processing_unit.name or ''!r}"
    if restriction is not None:
        yield f"the restriction of the event {element.name or ''!r} to {restriction} is dropped by am2inc"


#: The features of connections and module definitions that specify the cost of an access.
_COSTS = frozenset({"access_latency", "read_latency", "write_latency", "data_rate"})


def _check_access_cost(element: HwAccessElement | HwConnection | HwDefinition, context: Context) -> Iterator[str]:
    if isinstance(element, HwAccessElement):
        yield f"the cost of accesses to {element.destination.name if element.destination else ''!r} is ignored by am2inc"
    elif any(element.__dict__.get(name) is not None for name in _COSTS & element.__dict__.keys()):
        yield f"the access cost of {element.name or ''!r} is ignored by am2inc"


def _check_executing_unit(element: SchedulerAllocation, context: Context) -> Iterator[str]:
    core = element.executing_pu
    if core is not None and core not in element.responsibility:
        name = element.scheduler.name if element.scheduler is not None else None
        yield f"the executing processing unit {core.name or ''!r} of the scheduler {name or ''!r} is ignored by am2inc"


def _check_runnable_allocation(element: RunnableAllocation, context: Context) -> Iterator[str]:
    name = element.entity.name if element.entity is not None else None
    yield f"the allocation of the runnable {name or ''!r} is dropped by am2inc"


def _check_section_mapping(element: PhysicalSectionMapping, context: Context) -> Iterator[str]:
    yield f"the physical section mapping {element.name or ''!r} is dropped by am2inc"


def _check_data_consistency(element: OperatingSystem, context: Context) -> Iterator[str]:
    stated = element.os_data_consistency
    if stated is not None and (stated.mode not in (None, "_undefined_", "noProtection") or next(stated.contents(), None)):
        yield f"the data consistency of the operating system {element.name or ''!r} is ignored by am2inc"


def _check_interrupt_controllers(element: OperatingSystem, context: Context) -> Iterator[str]:
    count = len(element.interrupt_controllers)
    if count > 1:
        yield f"the {count} interrupt controllers of {element.name or ''!r} are merged by am2inc"


def _check_semaphore(element: Semaphore, context: Context) -> Iterator[str]:
    is_plain = element.semaphore_type in (None, "_undefined_", "CountingSemaphore")
    if not is_plain or element.priority_ceiling_protocol or element.effective("ownership"):
        yield f"the semaphore {element.name or ''!r} is changed to a plain counting semaphore by am2inc"


def _check_mode_values(element: Stimulus, context: Context) -> Iterator[str]:
    if element.set_mode_value_list is not None:
        yield f"the mode values set by the stimulus {element.name or ''!r} are ignored by am2inc"


RULES = (
    ModelRule(
        id="INC-CO-KIND",
        title="unsupported constraint or requirement",
        severity=Severity.WARNING,
        target=_DROPPED,
        check=_check_constraint,
        rationale="am2inc converts only latency constraints of event chains. It drops all other constraints and all requirements, "
        "and prints one warning per class without the names of the objects.",
        remedy="Check timing requirements with amuros analyze, or enter them by hand after the import.",
        fails="""
<constraintsModel>
  <requirements xsi:type="am:ProcessRequirement" name="R"/>
</constraintsModel>
""",
        passes="""
<constraintsModel/>
""",
    ),
    ModelRule(
        id="INC-EV-LABEL-RUN",
        title="event restricted to a runnable or core",
        severity=Severity.WARNING,
        target=(LabelEvent, ProcessEvent, RunnableEvent),
        check=_check_event_restriction,
        rationale="am2inc silently drops the restriction, so the event applies to all runnables and all cores. It keeps only a "
        "restriction to a process.",
        remedy="Remove the restriction, or restrict the event to a process instead.",
        fails="""
<swModel>
  <runnables name="R"/>
  <labels name="L"/>
</swModel>
<eventModel>
  <events xsi:type="am:LabelEvent" name="e" entity="L?type=Label" eventType="read" runnable="R?type=Runnable"/>
</eventModel>
""",
        edits={
            '  <runnables name="R"/>\n': "",
            'eventType="read" runnable="R?type=Runnable"': 'eventType="read"',
        },
    ),
    ModelRule(
        id="INC-HW-ACCESS",
        title="memory access timing",
        severity=Severity.WARNING,
        target=(HwAccessElement, HwConnection, HwDefinition),
        check=_check_access_cost,
        rationale="am2inc silently ignores access elements, access paths, latencies and data rates, so the time of memory "
        "accesses is lost.",
        remedy="Include the access times in the Ticks of the runnables, or do not rely on them after the import.",
        fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core">
      <accessElements name="a"/>
    </modules>
  </structures>
</hwModel>
""",
        edits={
            """<modules xsi:type="am:ProcessingUnit" name="core">
      <accessElements name="a"/>
    </modules>""": '<modules xsi:type="am:ProcessingUnit" name="core"/>',
        },
    ),
    ModelRule(
        id="INC-MAP-EXECPU",
        title="scheduler executed by another core",
        severity=Severity.INFO,
        target=SchedulerAllocation,
        check=_check_executing_unit,
        rationale="am2inc ignores the core that executes a scheduler. It reads only the cores for which the scheduler is "
        "responsible.",
        remedy="Remove the executing processing unit, or do not rely on it after the import.",
        fails="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core"/>
  </structures>
</hwModel>
<mappingModel>
  <schedulerAllocation executingPU="core?type=ProcessingUnit"/>
</mappingModel>
""",
        edits={"<schedulerAllocation": '<schedulerAllocation responsibility="core?type=ProcessingUnit"'},
    ),
    ModelRule(
        id="INC-MAP-RUNNABLE",
        title="runnable allocation",
        severity=Severity.WARNING,
        target=RunnableAllocation,
        check=_check_runnable_allocation,
        rationale="am2inc drops runnable allocations and prints a warning.",
        remedy="Allocate the tasks that call the runnable.",
        fails="""
<swModel>
  <runnables name="R"/>
</swModel>
<mappingModel>
  <runnableAllocation entity="R?type=Runnable"/>
</mappingModel>
""",
        passes="""
<mappingModel/>
""",
    ),
    ModelRule(
        id="INC-MAP-SECTION",
        title="physical section mapping",
        severity=Severity.WARNING,
        target=PhysicalSectionMapping,
        check=_check_section_mapping,
        rationale="am2inc drops physical section mappings and prints a warning.",
        remedy="Map the labels to memories directly.",
        fails="""
<mappingModel>
  <physicalSectionMapping name="M"/>
</mappingModel>
""",
        passes="""
<mappingModel/>
""",
    ),
    ModelRule(
        id="INC-OS-CONSISTENCY",
        title="operating system with data consistency",
        severity=Severity.WARNING,
        target=OperatingSystem,
        check=_check_data_consistency,
        rationale="am2inc silently ignores how an operating system keeps data consistent, so values can change between two accesses "
        "of a job.",
        remedy="Model the protection, e.g. with semaphores or copies of the labels, or do not rely on it after the import.",
        fails="""
<osModel>
  <operatingSystems name="OS">
    <osDataConsistency mode="automaticProtection"/>
  </operatingSystems>
</osModel>
""",
        edits={'mode="automaticProtection"': 'mode="noProtection"'},
    ),
    ModelRule(
        id="INC-OS-IC",
        title="several interrupt controllers",
        severity=Severity.INFO,
        target=OperatingSystem,
        check=_check_interrupt_controllers,
        rationale="am2inc merges all interrupt controllers of an operating system. The ISRs keep the cores of their own "
        "controllers.",
        remedy="Use one interrupt controller per operating system, or expect all its ISRs to be scheduled together.",
        fails="""
<osModel>
  <operatingSystems name="OS">
    <interruptControllers name="A"/>
    <interruptControllers name="B"/>
  </operatingSystems>
</osModel>
""",
        edits={'    <interruptControllers name="B"/>\n': ""},
    ),
    ModelRule(
        id="INC-OS-SEMA-TYPE",
        title="semaphore other than a counting semaphore",
        severity=Severity.WARNING,
        target=Semaphore,
        check=_check_semaphore,
        rationale="am2inc silently drops the type, the priority ceiling protocol and the ownership of semaphores.",
        remedy="Use counting semaphores without priority ceiling and with ownership=false (the default since AMALTHEA 3.0.0 is true), "
        "or expect different blocking times after the import.",
        fails="""
<osModel>
  <semaphores name="S" semaphoreType="Mutex"/>
</osModel>
""",
        edits={'semaphoreType="Mutex"': 'semaphoreType="CountingSemaphore" ownership="false"'},
    ),
    ModelRule(
        id="INC-ST-MODELIST",
        title="mode values set by a stimulus",
        severity=Severity.WARNING,
        target=Stimulus,
        check=_check_mode_values,
        rationale="am2inc silently ignores mode values that are set by stimuli.",
        remedy="Set the mode labels in a runnable instead.",
        fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <setModeValueList/>
  </stimuli>
</stimuliModel>
""",
        passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S"/>
</stimuliModel>
""",
    ),
)
