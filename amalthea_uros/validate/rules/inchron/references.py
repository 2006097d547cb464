"""Names and references: where am2inc finds no object, or another one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from urllib.parse import unquote_plus

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element, references_of
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.naming import name_of, unique_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, model_rule
from amalthea_uros.validate.rules.inchron.importer import has_encoded_name, has_id, metamodel, without_namespace


def missing(parts: Mapping[str, object]) -> str:
    """The names of the parts that are None, such as "stimulus or response"."""
    return " or ".join(name for name, part in parts.items() if part is None)


#: The reference that an activity item needs.
OF_ITEMS: Mapping[type[am.ActivityGraphItem], str] = {
    am.RunnableCall: "runnable",
    am.LabelAccess: "data",
    am.ModeLabelAccess: "data",
    am.InterProcessTrigger: "stimulus",
}


#: The references whose target am2inc uses without a check, by their XML names: it crashes if there is none.
_CRASHING: Mapping[type[Element], tuple[str, ...]] = {
    **{item: (name,) for item, name in OF_ITEMS.items()},
    am.ModeValueCondition: ("label",),
    am.ModeLabelCondition: ("label1", "label2"),
    am.ProcessingUnit: ("frequencyDomain",),
    am.TaskAllocation: ("task",),
    am.MemoryMapping: ("abstractElement",),
    am.EventChain: ("stimulus", "response"),
}


#: Those of which am2inc aborts the conversion; before 3.0 it does not read them.
_REFUSED: Mapping[type[Element], tuple[str, ...]] = {
    am.ServerCall: ("serverRunnable",),
    am.SenderReceiverCommunication: ("label",),
}


def is_needed(holder: Element, name: str) -> bool:
    """Whether am2inc crashes or aborts if a reference, given by its XML name, leads to nothing."""
    # am2inc does not read the calls of prototypes, and reads the keys of parameters of allocations with care.
    if isinstance(holder.container, am.ProcessPrototype):
        return False
    if isinstance(holder, am.SchedulingParameter):
        return name == "key" and isinstance(holder.container, am.TaskScheduler)
    tables = (_CRASHING,) if metamodel(holder) < "3" else (_CRASHING, _REFUSED)
    return any(isinstance(holder, cls) and name in names for table in tables for cls, names in table.items())


@model_rule("INC-EC-ENDS", am.AbstractEventChain)
def _check_chain(element: am.AbstractEventChain, context: Context) -> Iterator[str | Downgraded]:
    absent = missing({"stimulus": element.stimulus, "response": element.response})
    if absent:
        message = f"the event chain {element.name or ''!r} has no {absent}"
        yield f"{message} of its own" if isinstance(element, am.EventChain) and element.items else Downgraded(message)


@model_rule("INC-HW-PU-CLOCK", am.ProcessingUnit)
def _check_processing_unit(element: am.ProcessingUnit, context: Context) -> Iterator[str]:
    if element.frequency_domain is None:
        yield f"the processing unit {element.name or ''!r} has no frequency domain"


@model_rule("INC-LC-MAX", am.EventChainLatencyConstraint)
def _check_latency_constraint(element: am.EventChainLatencyConstraint, context: Context) -> Iterator[str]:
    absent = missing({"maximum": element.maximum, "type": None if element.type == "_undefined_" else element.type})
    if absent:
        yield f"the latency constraint {element.name or ''!r} has no {absent}"


@model_rule("INC-MAP-ISR", am.ISRAllocation)
def _check_isr_allocation(element: am.ISRAllocation, context: Context) -> Iterator[str]:
    absent = missing({"ISR": element.isr, "interrupt controller": element.controller})
    if absent:
        yield f"the ISR allocation has no {absent}"


@model_rule("INC-MAP-MEMORY", am.MemoryMapping)
def _check_memory_mapping(element: am.MemoryMapping, context: Context) -> Iterator[str | Downgraded]:
    mapped = element.abstract_element
    if mapped is None:
        yield "the memory mapping has no element"
    elif element.memory is None:
        yield Downgraded(f"the memory mapping of {name_of(mapped)!r} has no memory")
    elif not isinstance(mapped, am.Label):
        yield Downgraded(f"the memory mapping of the {type(mapped).__name__} {name_of(mapped)!r} is dropped by am2inc")


@model_rule("INC-MAP-SCHED", am.Scheduler, am.SchedulerAllocation)
def _check_scheduler(element: am.Scheduler | am.SchedulerAllocation, context: Context) -> Iterator[str]:
    if isinstance(element, am.Scheduler) and element not in context.once(_responsible):
        yield f"the scheduler {element.name or ''!r} is not responsible for any processing unit"
    if isinstance(element, am.SchedulerAllocation) and element.scheduler is None:
        yield "the scheduler allocation has no scheduler"


def _responsible(context: Context) -> set[am.Scheduler | None]:
    return {allocation.scheduler for allocation in context.all(am.SchedulerAllocation) if allocation.responsibility}


@model_rule("INC-MAP-TASK", am.TaskAllocation)
def _check_task_allocation(element: am.TaskAllocation, context: Context) -> Iterator[str | Downgraded]:
    absent = missing({"task": element.task, "scheduler": element.scheduler})
    if absent:
        message = f"the task allocation has no {absent}"
        yield message if element.task is None else Downgraded(message)


@model_rule("INC-OS-PARAM-KEY", am.SchedulingParameter)
def _check_parameter(element: am.SchedulingParameter, context: Context) -> Iterator[str]:
    if element.key is None and isinstance(element.container, am.TaskScheduler):
        yield f"a scheduling parameter of the scheduler {element.container.name or ''!r} has no key"


@model_rule("INC-SW-CONDSET", am.WhileLoop, am.SwitchEntry, am.ModeSwitchEntry)
def _check_condition(element: am.WhileLoop | am.SwitchEntry | am.ModeSwitchEntry, context: Context) -> Iterator[str]:
    if not (element.condition and element.condition.entries):
        yield (
            "the while loop has no condition"
            if isinstance(element, am.WhileLoop)
            else f"the switch entry {element.name or ''!r} has no condition"
        )


#: What each of these items needs.
_PARTS = {**OF_ITEMS, **dict.fromkeys((am.SetEvent, am.ClearEvent, am.WaitEvent), "event_mask")}


@model_rule("INC-SW-REF", *_PARTS)
def _check_item(element: am.ActivityGraphItem, context: Context) -> Iterator[str]:
    feature = _PARTS[type(element)]
    # am2inc does not read the calls of prototypes.
    if getattr(element, feature) is None and not isinstance(element.container, am.ProcessPrototype):
        yield f"the {feature.replace('_', ' ')} of the {type(element).__name__} is not set"


@model_rule("INC-SW-SERVER", am.ServerCall, am.SenderReceiverCommunication)
def _check_server_call(element: am.ServerCall | am.SenderReceiverCommunication, context: Context) -> Iterator[str | Downgraded]:
    wanted = "server runnable" if isinstance(element, am.ServerCall) else "label"
    if metamodel(element) < "3":
        yield Downgraded(f"the {type(element).__name__} is dropped by am2inc, because the model is older than AMALTHEA 3.0")
    elif (element.server_runnable if isinstance(element, am.ServerCall) else element.label) is None:
        yield f"the {type(element).__name__} has no {wanted}"


@model_rule("INC-IO-NAME", am.IReferable)
def _check_name(element: am.IReferable, context: Context) -> Iterator[str]:
    same = context.namesakes.get(element)
    if same is not None:
        yield f"the name {unique_name(element)!r} is used by {len(same)} objects"
    elif isinstance(element, am.INamespaceMember) and element.namespace is not None:
        count = context.once(_plain_names)[type(element), element.name]
        if count > 1:
            objects = f"{count} objects of the class {type(element).__name__}"
            yield f"the name {element.name or ''!r} is used by {objects} in different namespaces"


def _plain_names(context: Context) -> Counter[tuple[type[Element], str | None]]:
    """How often a class uses a name, regardless of the namespace."""
    return Counter(
        (type(member), member.name) for member in context.all(am.INamespaceMember) if isinstance(member, am.IReferable)
    )


@model_rule("INC-IO-REF", Element, among=lambda context: context.dangling, is_about_files=True)
def _check_ref(element: Element, context: Context) -> Iterator[str | Downgraded]:
    for name, text in context.dangling.get(element, ()):
        if text not in context.once(_unqualified_references):
            message = f"the reference {name!r} to {text!r} cannot be resolved"
            yield message if is_needed(element, name) else Downgraded(message)


def _unqualified_references(context: Context) -> frozenset[str]:
    return frozenset(context.once(without_namespace).values())


@model_rule("INC-IO-XMIID", am.Amalthea)
def _check_xmiid(element: am.Amalthea, context: Context) -> Iterator[str | Downgraded]:
    document = element.document
    label = next((label for label in context.all(am.LocalModeLabel) if label.document is document), None)
    if label is not None and document in context.once(_with_missing_ids):
        yield f"the file has local mode labels, e.g. {label.name or ''!r}, and objects without an xmi:id"
    lost = {target: is_crash for target, is_crash in context.once(_lost).items() if target.document is document}
    members = context.once(without_namespace)
    for why, targets in (
        ("references with its namespace", [target for target in lost if target in members]),
        ("references that encode its name", [target for target in lost if target not in members]),
    ):
        # An object that am2inc needs is the better example.
        for target in sorted(targets, key=lost.__getitem__, reverse=True)[:1]:
            message = f"{unique_name(target)!r} has no xmi:id, so {why} cannot be resolved"
            yield message if lost[target] else Downgraded(message)


def _with_missing_ids(context: Context) -> set[Document | None]:
    """The files with local mode labels or targets of references that have no `xmi:id`."""
    objects = {*context.all(am.LocalModeLabel), *(target for _, _, target in _references(context))}
    return {element.document for element in objects if not has_id(element)}


def _lost(context: Context) -> dict[Element, bool]:
    """The objects to which am2inc cannot resolve references, and whether it needs one of these references."""
    found: dict[Element, bool] = {}
    members = context.once(without_namespace)
    for holder, name, target in _references(context):
        if target in members or (has_encoded_name(target) and not has_id(target) and not _is_plain(holder, name, target)):
            xml_name = features_of(type(holder))[name].xml_name
            found[target] = found.get(target, False) or is_needed(holder, xml_name)
    return found


def _references(context: Context) -> Iterator[tuple[Element, str, Element]]:
    """The resolved references: object, feature and target."""
    for holder in context.all(Element):
        for name, value in references_of(holder):
            for target in value if isinstance(value, list) else (value,):
                if target.unresolved is None:
                    yield holder, name, target


def _is_plain(holder: Element, name: str, target: Element) -> bool:
    """Whether a reference is written without encoding, as am2inc computes names."""
    document, plain = holder.document, unquote_plus(unique_name(target))
    return document is not None and (holder, f"{features_of(type(holder))[name].xml_name} {plain}") in document.spellings
