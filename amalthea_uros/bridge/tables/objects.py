"""Where the objects are that a table alone converts: in the parts of a system, and in the sub-models of AMALTHEA."""

from __future__ import annotations

from typing import NamedTuple

from amalthea_uros.bridge.basics.entries import ClassTable
from amalthea_uros.bridge.tables.constraints import CONSTRAINTS, DATA_AGES, ORDERS
from amalthea_uros.bridge.tables.events import CHAINS, EVENTS
from amalthea_uros.bridge.tables.os import SEMAPHORES
from amalthea_uros.bridge.tables.software import CHANNELS, LABELS, MODE_LABELS, OS_EVENTS, PROCESSES, RUNNABLES
from amalthea_uros.bridge.tables.stimuli import CLOCKS, STIMULI
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element


class ObjectList(NamedTuple):
    """A list of objects.

    Attributes
    ----------
    part, field : the part of a system, and its field
    model_class, feature : the sub-model, and its feature
    """

    part: str
    field: str
    model_class: type[Element]
    feature: str
    table: ClassTable


#: In the order in which objects with the same name are found.
OBJECTS = (
    ObjectList("os", "semaphores", am.OSModel, "semaphores", SEMAPHORES),
    ObjectList("software", "tasks", am.SWModel, "tasks", PROCESSES),
    ObjectList("software", "isrs", am.SWModel, "isrs", PROCESSES),
    ObjectList("software", "runnables", am.SWModel, "runnables", RUNNABLES),
    ObjectList("software", "labels", am.SWModel, "labels", LABELS),
    ObjectList("software", "channels", am.SWModel, "channels", CHANNELS),
    ObjectList("software", "os_events", am.SWModel, "events", OS_EVENTS),
    ObjectList("software", "mode_labels", am.SWModel, "mode_labels", MODE_LABELS),
    ObjectList("stimuli", "stimuli", am.StimuliModel, "stimuli", STIMULI),
    ObjectList("stimuli", "clocks", am.StimuliModel, "clocks", CLOCKS),
    ObjectList("events", "events", am.EventModel, "events", EVENTS),
    ObjectList("events", "chains", am.ConstraintsModel, "event_chains", CHAINS),
    ObjectList("constraints", "constraints", am.ConstraintsModel, "timing_constraints", CONSTRAINTS),
    ObjectList("constraints", "data_ages", am.ConstraintsModel, "data_age_constraints", DATA_AGES),
    ObjectList("constraints", "orders", am.ConstraintsModel, "runnable_sequencing_constraints", ORDERS),
)
