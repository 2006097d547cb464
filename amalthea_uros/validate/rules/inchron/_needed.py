"""The references that am2inc follows without a check."""

from __future__ import annotations

from collections.abc import Mapping

from amalthea_uros.metamodel.classes import (
    ActivityGraphItem,
    EventChain,
    InterProcessTrigger,
    LabelAccess,
    MemoryMapping,
    ModeLabelAccess,
    ModeLabelCondition,
    ModeValueCondition,
    Process,
    ProcessingUnit,
    ProcessPrototype,
    RunnableCall,
    SchedulingParameter,
    SenderReceiverCommunication,
    ServerCall,
    TaskAllocation,
    TaskScheduler,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.rules.inchron._importer import metamodel

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
