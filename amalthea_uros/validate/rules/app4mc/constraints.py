"""Event chains, data scopes, and constraints on where objects are placed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import chain, pairwise

from amalthea_uros._internal.plural import counted
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.chains import parts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.execution import executing
from amalthea_uros.validate.rule import model_rule
from amalthea_uros.validate.scheduling import responsibilities
from amalthea_uros.validate.wording import joined


@model_rule("AM-Constraints-EventChain", am.AbstractEventChain)
def _check_eventchain(element: am.AbstractEventChain, context: Context) -> Iterator[str]:
    segments = parts(element)
    if element.item_type == "parallel" or not segments or any(segment.unresolved is not None for segment in segments):
        return
    if element.stimulus is not segments[0].stimulus:
        yield "the first segment does not start with the stimulus of the chain"
    if element.response is not segments[-1].response:
        yield "the last segment does not end with the response of the chain"
    for number, (first, then) in enumerate(pairwise(segments), start=2):
        if first.response is not then.stimulus:
            yield f"segment {number} does not start with the response of segment {number - 1}"


@model_rule("DOC-ProcessScope", am.RunnableSequencingConstraint)
def _check_processscope(element: am.RunnableSequencingConstraint, context: Context) -> Iterator[str]:
    groups = element.runnable_groups
    # Prototypes are not executed, so a scope with prototypes cannot be evaluated.
    scope = {process for process in element.process_scope if isinstance(process, am.Process) and process.unresolved is None}
    if len(groups) < 2:
        yield f"{element.name!r} has {counted(len(groups), 'runnable group')}, but needs at least 2"
    elif scope and len(scope) == len(set(element.process_scope)):
        inside = sum(any(_is_inside(runnable, scope, context) for runnable in group.runnables) for group in groups)
        if inside < 2:
            yield f"{element.name!r} has {counted(inside, 'runnable group')} in its process scope, but needs at least 2"


def _is_inside(runnable: am.Runnable, scope: set[am.Process], context: Context) -> bool:
    """Whether a runnable runs in the scope, or no process is known to execute it."""
    processes = executing(runnable, context)
    return not processes or not scope.isdisjoint(processes)


#: The places of each mapped object, as an ordered set (a dictionary without values).
Places = dict[Element, dict[Element, None]]


def memories(context: Context) -> Places:
    """The memories of labels: those of their own mappings, or else those of their section."""
    sections = _gathered(
        (part, mapping.memory)
        for mapping in context.all(am.PhysicalSectionMapping)
        for part in (*mapping.origin, *mapping.labels)
    )
    labels = _gathered(
        (label, memory)
        for label in context.all(am.Label)
        if label.section is not None
        for memory in sections.get(label.section, ())
    )
    own = _gathered((mapping.abstract_element, mapping.memory) for mapping in context.all(am.MemoryMapping))
    return labels | sections | own


def schedulers(context: Context) -> Places:
    """The schedulers of tasks and runnables, and the interrupt controllers of ISRs."""
    tasks = _gathered((allocation.task, allocation.scheduler) for allocation in context.all(am.TaskAllocation))
    isrs = _gathered((allocation.isr, allocation.controller) for allocation in context.all(am.ISRAllocation))
    runnables = _gathered((allocation.entity, allocation.scheduler) for allocation in context.all(am.RunnableAllocation))
    return _with_runnables(tasks | isrs, runnables, context)


def cores(context: Context) -> Places:
    """The processing units on which processes and runnables may run."""

    def served(scheduler: am.Scheduler | None, affinity: Iterable[am.ProcessingUnit] = ()) -> list[am.ProcessingUnit]:
        wanted = set(affinity)
        found = responsibilities(context).get(scheduler, []) if scheduler is not None else []
        return [core for core in found if core in wanted or not wanted]

    tasks = _gathered((a.task, core) for a in context.all(am.TaskAllocation) for core in served(a.scheduler, a.affinity))
    isrs = _gathered((a.isr, core) for a in context.all(am.ISRAllocation) for core in served(a.controller))
    runnables = _gathered((a.entity, core) for a in context.all(am.RunnableAllocation) for core in served(a.scheduler))
    return _with_runnables(tasks | isrs, runnables, context)


def _with_runnables(processes: Places, stated: Places, context: Context) -> Places:
    """Add the runnables, by their own allocations, or else by those of the processes that execute them."""
    running = _gathered(
        (runnable, place)
        for runnable in context.all(am.Runnable)
        for process in executing(runnable, context)
        for place in processes.get(process, ())
    )
    return processes | running | stated


def _gathered(pairs: Iterable[tuple[Element | None, Element | None]]) -> Places:
    found: Places = {}
    for thing, place in pairs:
        if thing is not None and place is not None:
            found.setdefault(thing, {})[place] = None
    return found


#: For each kind of target: the feature that lists the relevant targets, and the function that finds the places of objects.
_TARGETS: dict[type[Element], tuple[str, Callable[[Context], Places]]] = {
    am.TargetMemory: ("memories", memories),
    am.TargetCore: ("cores", cores),
    am.TargetScheduler: ("schedulers", schedulers),
}


@model_rule("DOC-Pairing-Separation", am.AffinityConstraint)
def _check_pairing_separation(element: am.AffinityConstraint, context: Context) -> Iterator[str]:
    target = getattr(element, "target", None)
    default = am.TargetMemory if isinstance(element, am.DataConstraint) else am.TargetCore
    feature, places_of = _TARGETS[default if target is None else type(target)]
    counting = set(getattr(target, feature, ()))
    places = context.once(places_of)
    groups = [
        {member: [p for p in places[member] if not counting or p in counting] for member in group if member in places}
        for group in _groups(element, context)
    ]
    if isinstance(element, am.PairingConstraint):
        (members,) = groups
        if members and not set.intersection(*map(set, members.values())):
            where = ", ".join(f"{_name(each)} is on {_names(places[each])}" for each in members)
            yield f"the objects paired by {element.name!r} have no common target: {where}"
    else:
        yield from _not_apart(element, groups)


def _groups(constraint: am.AffinityConstraint, context: Context) -> list[Iterable[Element]]:
    groups = (
        [getattr(constraint, "group", None)]
        if isinstance(constraint, am.PairingConstraint)
        else getattr(constraint, "groups", [])
    )
    return [_members(group, constraint, context) for group in groups]


def _members(group: Element | None, constraint: am.AffinityConstraint, context: Context) -> Iterable[Element]:
    match group:
        case am.LabelEntityGroup():
            return group.labels
        case am.RunnableEntityGroup():
            return group.runnables
        case am.ProcessEntityGroup():
            return group.processes
        case am.TagGroup():
            kind = am.Runnable if isinstance(constraint, am.RunnableConstraint) else am.Process
            return [each for each in context.once(_tagged).get(group.tag, []) if isinstance(each, kind)]
    return []


def _tagged(context: Context) -> dict[am.Tag | None, list[Element]]:
    found: dict[am.Tag | None, list[Element]] = {}
    for each in context.all(am.ITaggable):
        for tag in each.tags:
            found.setdefault(tag, []).append(each)
    return found


def _not_apart(constraint: am.AffinityConstraint, groups: list[dict[Element, list[Element]]]) -> Iterator[str]:
    held: dict[Element, list[list[Element]]] = {}
    for number, group in enumerate(groups):
        for member, member_places in group.items():
            for place in member_places:
                held.setdefault(place, [[] for _ in groups])[number].append(member)
    for place, by_group in held.items():
        present = [members for members in by_group if members]
        if len(groups) == 1:
            yield f"{_name(place)} is used by {_names(present[0])}, which {constraint.name!r} forbids"
        elif len(present) > 1:
            yield f"{_name(place)} is shared by {_names(chain.from_iterable(present))}, which {constraint.name!r} separates"


def _names(elements: Iterable[Element]) -> str:
    return joined(map(_name, elements))


def _name(element: Element) -> str:
    return repr(element.qualified_name)
