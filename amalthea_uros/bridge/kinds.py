"""Kinds of named objects; names are unique within a kind, and references are resolved within it."""

from __future__ import annotations

from enum import Enum, auto

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element


class Kind(Enum):
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
KINDS: dict[type[Element], Kind] = {
    am.FrequencyDomain: Kind.CLOCK,
    am.ProcessingUnitDefinition: Kind.CORE_TYPE,
    am.HwStructure: Kind.STRUCTURE,
    am.HwModule: Kind.MODULE,
    am.HwConnection: Kind.MODULE,
    am.Scheduler: Kind.SCHEDULER,
    am.OsOverhead: Kind.OVERHEAD,
    am.OperatingSystem: Kind.OPERATING_SYSTEM,
    am.Semaphore: Kind.SEMAPHORE,
    am.Stimulus: Kind.STIMULUS,
    am.Clock: Kind.STIMULUS_CLOCK,
    am.Process: Kind.PROCESS,
    am.Runnable: Kind.RUNNABLE,
    am.Label: Kind.DATA,
    am.Channel: Kind.DATA,
    am.OsEvent: Kind.OS_EVENT,
    am.Mode: Kind.MODE,
    am.ModeLabel: Kind.MODE_LABEL,
    am.Event: Kind.EVENT,
    am.EventChain: Kind.CHAIN,
    am.TimingConstraint: Kind.CONSTRAINT,
    am.DataAgeConstraint: Kind.CONSTRAINT,
    am.RunnableSequencingConstraint: Kind.CONSTRAINT,
}

_KIND_OF: dict[type[Element], Kind | None] = {}


def kind_of(cls: type[Element]) -> Kind | None:
    """The kind of the objects of a class; None if they are not referenced by name."""
    if cls not in _KIND_OF:
        _KIND_OF[cls] = next((KINDS[base] for base in cls.__mro__ if base in KINDS), None)
    return _KIND_OF[cls]
