"""Summary of a model, for `amuros info`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from fractions import Fraction
from typing import Any

from amalthea_uros._internal.records import dataclass
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.units import FREQUENCY, frequency_text


@dataclass(frozen=True, slots=True)
class DocumentSummary:
    """One file: path, AMALTHEA version, number of objects, size in characters, whether it is zipped.

    Attributes
    ----------
    migrated_from : the older version of the file, if the model was migrated in memory
    """

    path: str
    version: str
    objects: int
    characters: int
    compressed: bool
    migrated_from: str | None = None


@dataclass(frozen=True, slots=True)
class CoreSummary:
    """A processing unit: its structure, clock, and responsible schedulers."""

    name: str
    structure: str
    definition: str
    frequency: str
    schedulers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ProcessSummary:
    """A task or ISR: its activation, its scheduler, and the number of runnable calls in its activity graph."""

    name: str
    kind: str
    stimuli: tuple[str, ...]
    priority: str
    preemption: str
    scheduler: str
    runnable_calls: int


@dataclass(frozen=True, slots=True)
class ChainSummary:
    """An event chain from stimulus to response; `items` counts those of all levels."""

    name: str
    stimulus: str
    response: str
    items: int


@dataclass(frozen=True, slots=True)
class ModelSummary:
    """A whole model.

    Attributes
    ----------
    counts : number of objects per class, the most frequent first
    unresolved : number of references for which no object was found
    """

    documents: tuple[DocumentSummary, ...]
    counts: dict[str, int]
    cores: tuple[CoreSummary, ...]
    memories: tuple[str, ...]
    processes: tuple[ProcessSummary, ...]
    chains: tuple[ChainSummary, ...]
    unresolved: int


def summarise(model: Model) -> ModelSummary:
    """Summary of a model."""
    objects = list(model.walk())
    counts = Counter(type(element).__name__ for element in objects)
    ordered = sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    schedulers = _schedulers_of_cores(objects)
    allocations = _allocations(objects)
    return ModelSummary(
        documents=tuple(_document(document) for document in model.documents),
        counts=dict(ordered),
        cores=tuple(_core(core, schedulers.get(core, ())) for core in _of(objects, am.ProcessingUnit)),
        memories=tuple(name_of(memory) for memory in _of(objects, am.Memory)),
        processes=tuple(_process(process, allocations.get(process)) for process in _of(objects, am.Process)),
        chains=tuple(_chain(chain) for chain in _of(objects, am.EventChain)),
        unresolved=sum(1 for _ in model.unresolved()),
    )


def _of(objects: list[Element], cls: type[Any]) -> Iterable[Any]:
    return (element for element in objects if isinstance(element, cls))


def _document(document: Document) -> DocumentSummary:
    source = document.source
    return DocumentSummary(
        path=str(document.path or "unsaved"),
        version=document.version,
        objects=sum(1 for _ in document.root.walk()),
        characters=len(source.text) if source else 0,
        compressed=bool(source and source.file.zip_entry),
        migrated_from=document.migrated_from,
    )


def _schedulers_of_cores(objects: list[Element]) -> dict[Element, tuple[str, ...]]:
    found: dict[Element, tuple[str, ...]] = {}
    for allocation in _of(objects, am.SchedulerAllocation):
        for core in allocation.responsibility:
            found[core] = (*found.get(core, ()), _scheduler(allocation.scheduler))
    return found


def _scheduler(scheduler: am.Scheduler | None) -> str:
    """Name and algorithm: `Scheduler_1 (OSEK)`."""
    if scheduler is None:
        return ""
    algorithm = name_of(scheduler.definition)
    older = scheduler.__dict__.get("scheduling_algorithm")
    if not algorithm and isinstance(older, Element):
        algorithm = type(older).__name__
    return f"{name_of(scheduler)} ({algorithm})" if algorithm else name_of(scheduler)


def _core(core: am.ProcessingUnit, schedulers: tuple[str, ...]) -> CoreSummary:
    domain = core.frequency_domain
    return CoreSummary(
        name=name_of(core),
        structure=name_of(core.container),
        definition=name_of(core.definition),
        frequency=_frequency(domain.default_value) if domain else "",
        schedulers=schedulers,
    )


def _frequency(value: am.Frequency | None) -> str:
    """A frequency in the unit that all results use for it; as it is in the model without a known unit."""
    unit = FREQUENCY.units.get(value.unit.value) if value is not None and value.unit is not None else None
    if value is None or unit is None:
        return quantity(value)
    return frequency_text(Fraction(str(value.value or 0)) * unit)


def quantity(value: am.Quantity | None) -> str:
    """A quantity as text: `10 ms`, `300 MHz`; "" for none."""
    if value is None:
        return ""
    number = getattr(value, "value", None) or 0
    unit = getattr(value, "unit", None)
    text = f"{number:.12g}" if isinstance(number, float) else str(number)
    return text if unit is None or unit.name == "UNDEFINED" else f"{text} {unit.value}"


def _allocations(objects: list[Element]) -> dict[Element, am.TaskAllocation | am.ISRAllocation]:
    found: dict[Element, am.TaskAllocation | am.ISRAllocation] = {}
    for allocation in _of(objects, am.TaskAllocation):
        if allocation.task is not None:
            found[allocation.task] = allocation
    for allocation in _of(objects, am.ISRAllocation):
        if allocation.isr is not None:
            found[allocation.isr] = allocation
    return found


def _process(process: am.Process, allocation: am.TaskAllocation | am.ISRAllocation | None) -> ProcessSummary:
    controller: Element | None = None
    if isinstance(allocation, am.TaskAllocation):
        controller = allocation.scheduler
    elif allocation is not None:
        controller = allocation.controller
    preemption = process.preemption.value if isinstance(process, am.Task) and process.preemption else ""
    return ProcessSummary(
        name=name_of(process),
        kind="isr" if isinstance(process, am.ISR) else "task",
        stimuli=tuple(map(stimulus_text, process.stimuli)),
        priority=priority_text(allocation),
        preemption=preemption,
        scheduler=name_of(controller),
        runnable_calls=sum(isinstance(part, am.RunnableCall) for part in process.walk()),
    )


def priority_text(allocation: am.TaskAllocation | am.ISRAllocation | None) -> str:
    """The priority of an allocation; "" if it states none."""
    if isinstance(allocation, am.ISRAllocation):
        return str(allocation.priority) if allocation.priority is not None else ""
    for parameter in allocation.scheduling_parameters if allocation else ():
        if not isinstance(parameter, am.SchedulingParameter):
            return str(parameter.priority) if parameter.priority is not None else ""
        if name_of(parameter.key) == "priority" and isinstance(parameter.value, am.IntegerObject):
            return str(parameter.value.value)
    return ""


def stimulus_text(stimulus: am.Stimulus) -> str:
    """A short description of a stimulus: `every 10 ms, offset 2 ms`."""
    if isinstance(stimulus, am.PeriodicStimulus | am.PeriodicSyntheticStimulus | am.PeriodicBurstStimulus):
        offset = f", offset {quantity(stimulus.offset)}" if stimulus.offset and stimulus.offset.value else ""
        what = "" if isinstance(stimulus, am.PeriodicStimulus) else f" ({type(stimulus).__name__})"
        return f"every {quantity(stimulus.recurrence) or '?'}{offset}{what}"
    if isinstance(stimulus, am.RelativePeriodicStimulus):
        return f"sporadic ({name_of(stimulus)})"
    if isinstance(stimulus, am.SingleStimulus):
        return f"once at {quantity(stimulus.occurrence) or '?'}"
    if isinstance(stimulus, am.InterProcessStimulus):
        return f"triggered ({name_of(stimulus)})"
    return f"{type(stimulus).__name__.removesuffix('Stimulus')} ({name_of(stimulus)})"


def _chain(chain: am.EventChain) -> ChainSummary:
    items = sum(isinstance(part, am.EventChainItem) for part in chain.walk())
    return ChainSummary(name_of(chain), name_of(chain.stimulus), name_of(chain.response), items)


# For debuggers and notebooks


def representation(element: Element) -> str:
    """A short text such as `<Task 'Control', every 1 ms, priority 2>`; it does not fail for objects that are not complete."""
    name = element.__dict__.get("name")
    parts = [f"{type(element).__name__} {name!r}" if name else type(element).__name__]
    try:
        parts += _details(element)
    except (AttributeError, TypeError, ValueError):
        # A debugger shows objects whose values are of wrong types, too.
        parts.append("...")
    return f"<{', '.join(parts)}>"


def _details(element: Element) -> list[str]:
    match element:
        case am.Stimulus():
            return [stimulus_text(element)]
        case am.Quantity():
            return [quantity(element)]
        case am.Process():
            priority = next(filter(None, map(priority_text, _allocations_of(element))), "")
            return [*map(stimulus_text, element.stimuli), *([f"priority {priority}"] if priority else [])]
    return []


def _allocations_of(process: am.Process) -> Iterator[am.TaskAllocation | am.ISRAllocation]:
    """The allocations of a process, in the files of its model."""
    model = process.model
    roots = [document.root for document in model.documents] if model is not None else []
    for mapping in (part for root in roots for part in root.contents() if isinstance(part, am.MappingModel)):
        if isinstance(process, am.Task):
            yield from (each for each in mapping.task_allocation if each.task is process)
        if isinstance(process, am.ISR):
            yield from (each for each in mapping.isr_allocation if each.isr is process)
