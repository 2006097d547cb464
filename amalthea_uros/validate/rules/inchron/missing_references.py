"""References without which am2inc crashes, or drops an object."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    AbstractEventChain,
    ActivityGraphItem,
    ClearEvent,
    EventChain,
    EventChainLatencyConstraint,
    InterProcessTrigger,
    ISRAllocation,
    Label,
    LabelAccess,
    MemoryMapping,
    ModeLabelAccess,
    ModeLabelCondition,
    ModeSwitchEntry,
    ModeValueCondition,
    Process,
    ProcessingUnit,
    ProcessPrototype,
    RunnableCall,
    Scheduler,
    SchedulerAllocation,
    SchedulingParameter,
    SenderReceiverCommunication,
    ServerCall,
    SetEvent,
    SwitchEntry,
    TaskAllocation,
    TaskScheduler,
    WaitEvent,
    WhileLoop,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import SCHEDULER, TASK_EVENTS, runnable_with
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._importer import metamodel


def missing(parts: Mapping[str, object]) -> str:
    """The names of the parts that are None, such as "stimulus or response"."""
    return " or ".join(name for name, part in parts.items() if part is None)


#: The reference that an activity item needs.
OF_ITEMS: Mapping[type[ActivityGraphItem], str] = {
    RunnableCall: "runnable",
    LabelAccess: "data",
    ModeLabelAccess: "data",
    InterProcessTrigger: "stimulus",
}


#: The references whose target am2inc uses without a check, by their XML names: it crashes if there is none.
_CRASHING: Mapping[type[Element], tuple[str, ...]] = {
    **{item: (name,) for item, name in OF_ITEMS.items()},
    ModeValueCondition: ("label",),
    ModeLabelCondition: ("label1", "label2"),
    ProcessingUnit: ("frequencyDomain",),
    TaskAllocation: ("task",),
    Process: ("stimuli",),
    MemoryMapping: ("abstractElement",),
    EventChain: ("stimulus", "response"),
}


#: Those of which am2inc aborts the conversion; before 3.0 it does not read them.
_REFUSED: Mapping[type[Element], tuple[str, ...]] = {ServerCall: ("serverRunnable",), SenderReceiverCommunication: ("label",)}


def is_needed(holder: Element, name: str) -> bool:
    """Whether am2inc crashes or aborts if a reference, given by its XML name, leads to nothing."""
    # am2inc does not read the calls of prototypes, and reads the keys of parameters of allocations with care.
    if isinstance(holder.container, ProcessPrototype):
        return False
    if isinstance(holder, SchedulingParameter):
        return name == "key" and isinstance(holder.container, TaskScheduler)
    tables = (_CRASHING,) if metamodel(holder) < "3" else (_CRASHING, _REFUSED)
    return any(isinstance(holder, cls) and name in names for table in tables for cls, names in table.items())


def _check_chain(element: AbstractEventChain, context: Context) -> Iterator[str | Downgraded]:
    absent = missing({"stimulus": element.stimulus, "response": element.response})
    if absent:
        message = f"the event chain {element.name or ''!r} has no {absent}"
        yield f"{message} of its own" if isinstance(element, EventChain) and element.items else Downgraded(message)


def _check_processing_unit(element: ProcessingUnit, context: Context) -> Iterator[str]:
    if element.frequency_domain is None:
        yield f"the processing unit {element.name or ''!r} has no frequency domain"


def _check_latency_constraint(element: EventChainLatencyConstraint, context: Context) -> Iterator[str]:
    absent = missing({"maximum": element.maximum, "type": None if element.type == "_undefined_" else element.type})
    if absent:
        yield f"the latency constraint {element.name or ''!r} has no {absent}"


def _check_isr_allocation(element: ISRAllocation, context: Context) -> Iterator[str]:
    absent = missing({"ISR": element.isr, "interrupt controller": element.controller})
    if absent:
        yield f"the ISR allocation has no {absent}"


def _check_memory_mapping(element: MemoryMapping, context: Context) -> Iterator[str | Downgraded]:
    mapped = element.abstract_element
    if mapped is None:
        yield "the memory mapping has no element"
    elif element.memory is None:
        yield Downgraded(f"the memory mapping of {name_of(mapped)!r} has no memory")
    elif not isinstance(mapped, Label):
        yield Downgraded(f"the memory mapping of the {type(mapped).__name__} {name_of(mapped)!r} is dropped by am2inc")


def _check_scheduler(element: Scheduler | SchedulerAllocation, context: Context) -> Iterator[str]:
    if isinstance(element, Scheduler) and element not in context.once(_responsible):
        yield f"the scheduler {element.name or ''!r} is not responsible for any processing unit"
    if isinstance(element, SchedulerAllocation) and element.scheduler is None:
        yield "the scheduler allocation has no scheduler"


def _responsible(context: Context) -> set[Scheduler | None]:
    return {allocation.scheduler for allocation in context.all(SchedulerAllocation) if allocation.responsibility}


def _check_task_allocation(element: TaskAllocation, context: Context) -> Iterator[str | Downgraded]:
    absent = missing({"task": element.task, "scheduler": element.scheduler})
    if absent:
        message = f"the task allocation has no {absent}"
        yield message if element.task is None else Downgraded(message)


def _check_parameter(element: SchedulingParameter, context: Context) -> Iterator[str]:
    if element.key is None and isinstance(element.container, TaskScheduler):
        yield f"a scheduling parameter of the scheduler {element.container.name or ''!r} has no key"


def _check_condition(element: WhileLoop | SwitchEntry | ModeSwitchEntry, context: Context) -> Iterator[str]:
    if not (element.condition and element.condition.entries):
        yield (
            "the while loop has no condition"
            if isinstance(element, WhileLoop)
            else f"the switch entry {element.name or ''!r} has no condition"
        )


#: What each of these items needs.
_PARTS = {**OF_ITEMS, **dict.fromkeys((SetEvent, ClearEvent, WaitEvent), "event_mask")}


def _check_item(element: ActivityGraphItem, context: Context) -> Iterator[str]:
    feature = _PARTS[type(element)]
    # am2inc does not read the calls of prototypes.
    if getattr(element, feature) is None and not isinstance(element.container, ProcessPrototype):
        yield f"the {feature.replace('_', ' ')} of the {type(element).__name__} is not set"


def _check_server_call(element: ServerCall | SenderReceiverCommunication, context: Context) -> Iterator[str | Downgraded]:
    wanted = "server runnable" if isinstance(element, ServerCall) else "label"
    if metamodel(element) < "3":
        yield Downgraded(f"the {type(element).__name__} is dropped by am2inc, because the model is older than AMALTHEA 3.0")
    elif (element.server_runnable if isinstance(element, ServerCall) else element.label) is None:
        yield f"the {type(element).__name__} has no {wanted}"


RULES = (
    ModelRule(
        id="INC-EC-ENDS",
        title="event chain without a stimulus or response",
        severity=Severity.ERROR,
        target=AbstractEventChain,
        check=_check_chain,
        rationale="am2inc crashes if an event chain with items has no stimulus or response of its own. It drops an event chain without "
        "items, and one with such a segment, and prints a warning.",
        remedy="Set the stimulus and the response of the event chain.",
        fails=f"""
{TASK_EVENTS}
<swModel>
  <tasks name="T"/>
</swModel>
<constraintsModel>
  <eventChains name="C" stimulus="a?type=ProcessEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain name="segment" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
  </eventChains>
</constraintsModel>
""",
        edits={
            """<eventChains name="C" stimulus="a?type=ProcessEvent">
    <items xsi:type="am:EventChainContainer">
      <eventChain name="segment" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>
    </items>
  </eventChains>""": '<eventChains name="C" stimulus="a?type=ProcessEvent" response="b?type=ProcessEvent"/>',
        },
    ),
    ModelRule(
        id="INC-HW-PU-CLOCK",
        title="processing unit without a clock",
        severity=Severity.ERROR,
        target=ProcessingUnit,
        check=_check_processing_unit,
        rationale="am2inc crashes with a segmentation fault.",
        remedy="Give the processing unit a frequency domain.",
        fails="""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core"/>
  </structures>
</hwModel>
""",
        edits={'name="core"': 'name="core" frequencyDomain="clock?type=FrequencyDomain"'},
    ),
    ModelRule(
        id="INC-LC-MAX",
        title="latency constraint without a maximum or type",
        severity=Severity.WARNING,
        target=EventChainLatencyConstraint,
        check=_check_latency_constraint,
        rationale="am2inc silently uses 0 for a missing maximum and Reaction for a missing type.",
        remedy="Set the maximum and the type (Age or Reaction).",
        fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L"/>
</constraintsModel>
""",
        edits={
            'name="L"/>': """name="L" type="Age">
    <maximum value="1" unit="ms"/>
  </timingConstraints>""",
        },
    ),
    ModelRule(
        id="INC-MAP-ISR",
        title="incomplete ISR allocation",
        severity=Severity.WARNING,
        target=ISRAllocation,
        check=_check_isr_allocation,
        rationale="am2inc silently skips the allocation.",
        remedy="Set the ISR and the interrupt controller.",
        fails="""
<swModel>
  <isrs name="I"/>
</swModel>
<mappingModel>
  <isrAllocation isr="I?type=ISR"/>
</mappingModel>
""",
        edits={
            "<swModel>": """<osModel>
  <operatingSystems name="OS">
    <interruptControllers name="C"/>
  </operatingSystems>
</osModel>
<swModel>""",
            'isr="I?type=ISR"': 'isr="I?type=ISR" controller="C?type=InterruptController"',
        },
    ),
    ModelRule(
        id="INC-MAP-MEMORY",
        title="unsupported memory mapping",
        severity=Severity.ERROR,
        target=MemoryMapping,
        check=_check_memory_mapping,
        rationale="am2inc crashes with a segmentation fault if the mapped element is missing. It silently drops mappings of "
        "anything but labels.",
        remedy="Map only labels, and set both the label and the memory.",
        fails="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="RAM"/>
  </structures>
</hwModel>
<mappingModel>
  <memoryMapping memory="RAM?type=Memory"/>
</mappingModel>
""",
        edits={
            "<mappingModel>": """<swModel>
  <labels name="L"/>
</swModel>
<mappingModel>""",
            'memory="RAM?type=Memory"': 'abstractElement="L?type=Label" memory="RAM?type=Memory"',
        },
    ),
    ModelRule(
        id="INC-MAP-SCHED",
        title="scheduler without a core",
        severity=Severity.WARNING,
        target=(Scheduler, SchedulerAllocation),
        check=_check_scheduler,
        rationale="am2inc silently creates a scheduler without a core.",
        remedy="Add a scheduler allocation with the scheduler and the processing units for which it is responsible.",
        fails=f"""
{SCHEDULER}
""",
        passes=f"""
<hwModel>
  <domains xsi:type="am:FrequencyDomain" name="clock">
    <defaultValue value="300" unit="MHz"/>
  </domains>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core"/>
  </structures>
</hwModel>
{SCHEDULER}
<mappingModel>
  <schedulerAllocation scheduler="S?type=TaskScheduler" responsibility="core?type=ProcessingUnit"/>
</mappingModel>
""",
    ),
    ModelRule(
        id="INC-MAP-TASK",
        title="incomplete task allocation",
        severity=Severity.ERROR,
        target=TaskAllocation,
        check=_check_task_allocation,
        rationale="am2inc crashes with a segmentation fault if the task is missing. If only the scheduler is missing, the task "
        "disappears (warning).",
        remedy="Set the task and the scheduler.",
        fails=f"""
{SCHEDULER}
<swModel>
  <tasks name="T"/>
</swModel>
<mappingModel>
  <taskAllocation scheduler="S?type=TaskScheduler"/>
</mappingModel>
""",
        edits={'scheduler="S?type=TaskScheduler"': 'task="T?type=Task" scheduler="S?type=TaskScheduler"'},
    ),
    ModelRule(
        id="INC-OS-PARAM-KEY",
        title="scheduling parameter without a key",
        severity=Severity.ERROR,
        target=SchedulingParameter,
        check=_check_parameter,
        rationale="am2inc crashes with a segmentation fault.",
        remedy="Set the key to the definition of the parameter.",
        fails="""
<osModel>
  <operatingSystems name="OS">
    <taskSchedulers name="S">
      <schedulingParameters>
        <value xsi:type="am:IntegerObject" value="3"/>
      </schedulingParameters>
    </taskSchedulers>
  </operatingSystems>
</osModel>
""",
        edits={
            "<schedulingParameters": '<schedulingParameters key="priority?type=SchedulingParameterDefinition"',
            "</osModel>": """  <schedulingParameterDefinitions name="priority"/>
</osModel>""",
        },
    ),
    ModelRule(
        id="INC-SW-CONDSET",
        title="branch or loop without a condition",
        severity=Severity.WARNING,
        target=(WhileLoop, SwitchEntry, ModeSwitchEntry),
        check=_check_condition,
        rationale="am2inc writes an empty condition and prints a warning about an object without a container.",
        remedy="Set the condition; use the default entry for all remaining cases.",
        fails=runnable_with("""
<items xsi:type="am:Switch">
  <entries name="e"/>
</items>
"""),
        edits={
            'name="e"/>': """name="e">
          <condition>
            <entries xsi:type="am:ModeValueCondition" relation="EQUAL" value="1"/>
          </condition>
        </entries>""",
        },
    ),
    ModelRule(
        id="INC-SW-REF",
        title="activity item without a target",
        severity=Severity.ERROR,
        target=tuple(_PARTS),
        check=_check_item,
        rationale="am2inc crashes with a segmentation fault.",
        remedy="Set the runnable, label, stimulus or event mask that the item uses.",
        fails=runnable_with('<items xsi:type="am:RunnableCall"/>'),
        edits={
            'xsi:type="am:RunnableCall"': 'xsi:type="am:RunnableCall" runnable="Other?type=Runnable"',
            "</swModel>": """  <runnables name="Other"/>
</swModel>""",
        },
    ),
    ModelRule(
        id="INC-SW-SERVER",
        title="unsupported server call or sender-receiver access",
        severity=Severity.ERROR,
        target=(ServerCall, SenderReceiverCommunication),
        check=_check_server_call,
        rationale="am2inc aborts the conversion if the server runnable or the label is missing. In models before AMALTHEA 3.0 it "
        "drops these items and prints a warning.",
        remedy="Set the server runnable or the label, and use AMALTHEA 3.0 or newer.",
        fails=runnable_with('<items xsi:type="am:SynchronousServerCall"/>'),
        edits={
            'xsi:type="am:SynchronousServerCall"': 'xsi:type="am:SynchronousServerCall" serverRunnable="Server?type=Runnable"',
            "</swModel>": """  <runnables name="Server"/>
</swModel>""",
        },
    ),
)
