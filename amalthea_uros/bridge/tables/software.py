"""The software model: processes, runnables and the data that they share."""

from __future__ import annotations

from typing import Any

from amalthea_uros.bridge.basics.codecs import PLAIN, SIZE, Codec, enumeration, marked, reference, references, same_names
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.bridge.tables.activities import ITEMS, PROTECTIONS
from amalthea_uros.bridge.tables.conditions import CONDITION
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.perf import software as perf
from amalthea_uros.perf.activities import Protection

#: Every process and runnable has a graph, also an empty one.
_GRAPH = Codec(
    lambda items, context: am.ActivityGraph(items=ITEMS.build(items, context)),
    lambda value, context, element: ITEMS.extract(value.items, context, element),
)
_ACTIVITIES = ("activity_graph", _GRAPH)


def _extract_stimuli(values: list[Any], context: Extracting, element: Element) -> tuple[str, ...]:
    """The names of stimuli; one that is not part of the model activates at an unknown rate."""
    return tuple(_STIMULUS.extract(value, context, element) or context.unresolved_stimulus(value) for value in values)


_STIMULUS = reference(ObjectKind.STIMULUS)
_STIMULI = Codec(references(ObjectKind.STIMULUS).build, _extract_stimuli)

_LIMIT = Codec(
    # 0 is what the metamodel gives where nothing is stated; a task has at least one job.
    lambda value, _: value,
    lambda value, _context, _element: max(1, value),
)
_PREEMPTION = same_names(perf.Preemption, am.Preemption)

PROCESSES = ClassTable(
    ClassEntry(
        perf.Task,
        am.Task,
        stimuli=_STIMULI,
        activities=_ACTIVITIES,
        preemption=_PREEMPTION,
        activation_limit=("multiple_task_activation_limit", _LIMIT),
    ),
    ClassEntry(
        perf.Isr, am.ISR, stimuli=_STIMULI, activities=_ACTIVITIES, category=same_names(perf.IsrCategory, am.ISRCategory)
    ),
)
RUNNABLES = ClassTable(
    ClassEntry(
        perf.Runnable,
        am.Runnable,
        activities=_ACTIVITIES,
        callback=PLAIN,
        service=PLAIN,
        is_overhead=("custom_properties", marked("osOverhead", default=False)),
        condition=("execution_condition", CONDITION),
    )
)
LABELS = ClassTable(
    ClassEntry(
        perf.Label,
        am.Label,
        size=SIZE,
        constant=PLAIN,
        volatile="b_volatile",
        protection=(
            "data_stability",
            enumeration({Protection[name]: am.LabelDataStability[other] for name, other in PROTECTIONS.items()}),
        ),
    )
)


def _build_element_type(size: int, context: Building) -> Element:
    """A type of that size; a channel has the size of its elements by way of their type."""
    definition = am.BaseTypeDefinition(name=f"bits_{size}", size=SIZE.build(size, context))
    known: Any = context.types.setdefault(size, definition)
    return known if context.is_at_least(3) else am.TypeRef(type_def=known)


def _extract_element_type(value: Any, context: Extracting, element: Element) -> int | None:
    definition = value.type_def if isinstance(value, am.TypeRef) else value
    size: int | None = SIZE.extract(getattr(definition, "size", None), context, element)
    return size


CHANNELS = ClassTable(
    ClassEntry(
        perf.Channel,
        am.Channel,
        element_size=("element_type", Codec(_build_element_type, _extract_element_type)),
        default_elements=PLAIN,
        capacity="max_elements",
        external=("custom_properties", marked("external", default=False)),
    )
)
OS_EVENTS = ClassTable(ClassEntry(perf.OsEvent, am.OsEvent))
MODE_LABELS = ClassTable(ClassEntry(perf.ModeLabel, am.ModeLabel, mode=reference(ObjectKind.MODE), initial="initial_value"))


def build_modes(modes: tuple[perf.Mode, ...], context: Building) -> list[am.Mode]:
    """Modes with literals, and those of numbers."""
    found: list[am.Mode] = []
    for mode in modes:
        literals = [am.ModeLiteral(name=literal) for literal in mode.literals]
        element = am.EnumMode(name=mode.name, literals=literals) if literals else am.NumericMode(name=mode.name)
        context.register(mode, element)
        found.append(element)
    return found


def extract_modes(elements: list[am.Mode], context: Extracting) -> tuple[perf.Mode, ...]:
    """The way back."""
    return tuple(
        perf.Mode(
            name=context.names[element],
            literals=tuple(literal.name or "" for literal in getattr(element, "literals", ())),
            origin=context.location(element),
        )
        for element in elements
    )
