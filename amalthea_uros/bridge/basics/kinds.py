"""Kinds of named objects; names are unique within a kind, and references are resolved within it."""

from __future__ import annotations

from enum import Enum, auto

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element


class ObjectKind(Enum):
    """A kind of named objects."""

    __hash__ = object.__hash__  # each kind is equal only to itself; the hash of Enum is slow

    CLOCK = auto()
    CORE_TYPE = auto()
    STRUCTURE = auto()
    MODULE = auto()
    SCHEDULER = auto()
    OVERHEAD = auto()
    OPERATING_SYSTEM = auto()
    SEMAPHORE = auto()
    STIMULUS = auto()
    STIMULUS_CLOCK = auto()
    PROCESS = auto()
    RUNNABLE = auto()
    DATA = auto()
    OS_EVENT = auto()
    MODE = auto()
    MODE_LABEL = auto()
    EVENT = auto()
    CHAIN = auto()
    CONSTRAINT = auto()


#: The kind of the objects of a class; subclasses belong to it too.
KINDS: dict[type[Element], ObjectKind] = {
    am.FrequencyDomain: ObjectKind.CLOCK,
    am.ProcessingUnitDefinition: ObjectKind.CORE_TYPE,
    am.HwStructure: ObjectKind.STRUCTURE,
    am.HwModule: ObjectKind.MODULE,
    am.HwConnection: ObjectKind.MODULE,
    am.Scheduler: ObjectKind.SCHEDULER,
    am.OsOverhead: ObjectKind.OVERHEAD,
    am.OperatingSystem: ObjectKind.OPERATING_SYSTEM,
    am.Semaphore: ObjectKind.SEMAPHORE,
    am.Stimulus: ObjectKind.STIMULUS,
    am.Clock: ObjectKind.STIMULUS_CLOCK,
    am.Process: ObjectKind.PROCESS,
    am.Runnable: ObjectKind.RUNNABLE,
    am.Label: ObjectKind.DATA,
    am.Channel: ObjectKind.DATA,
    am.OsEvent: ObjectKind.OS_EVENT,
    am.Mode: ObjectKind.MODE,
    am.ModeLabel: ObjectKind.MODE_LABEL,
    am.Event: ObjectKind.EVENT,
    am.EventChain: ObjectKind.CHAIN,
    am.TimingConstraint: ObjectKind.CONSTRAINT,
    am.DataAgeConstraint: ObjectKind.CONSTRAINT,
    am.RunnableSequencingConstraint: ObjectKind.CONSTRAINT,
}

_KIND_OF: dict[type[Element], ObjectKind | None] = {}


def kind_of(cls: type[Element]) -> ObjectKind | None:
    """The kind of the objects of a class; None if they are not referenced by name."""
    if cls not in _KIND_OF:
        _KIND_OF[cls] = next((KINDS[base] for base in cls.__mro__ if base in KINDS), None)
    return _KIND_OF[cls]
