"""Violated pairing or separation constraint."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import chain

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    AffinityConstraint,
    DataConstraint,
    ITaggable,
    LabelEntityGroup,
    PairingConstraint,
    Process,
    ProcessEntityGroup,
    Runnable,
    RunnableConstraint,
    RunnableEntityGroup,
    Tag,
    TagGroup,
    TargetCore,
    TargetMemory,
    TargetScheduler,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.app4mc._places import Places, cores, memories, schedulers
from amalthea_uros.validate.wording import joined

#: For each kind of target: the feature that lists the relevant targets, and the function that finds the places of objects.
_TARGETS: dict[type[Element], tuple[str, Callable[[Context], Places]]] = {
    TargetMemory: ("memories", memories),
    TargetCore: ("cores", cores),
    TargetScheduler: ("schedulers", schedulers),
}


def _check(element: AffinityConstraint, context: Context) -> Iterator[str]:
    target = getattr(element, "target", None)
    default = TargetMemory if isinstance(element, DataConstraint) else TargetCore
    feature, places_of = _TARGETS[default if target is None else type(target)]
    counting = set(getattr(target, feature, ()))
    places = context.once(places_of)
    groups = [
        {member: [p for p in places[member] if not counting or p in counting] for member in group if member in places}
        for group in _groups(element, context)
    ]
    if isinstance(element, PairingConstraint):
        (members,) = groups
        if members and not set.intersection(*map(set, members.values())):
            where = ", ".join(f"{_name(each)} is on {_names(places[each])}" for each in members)
            yield f"the objects paired by {element.name!r} have no common target: {where}"
    else:
        yield from _not_apart(element, groups)


def _groups(constraint: AffinityConstraint, context: Context) -> list[Iterable[Element]]:
    groups = (
        [getattr(constraint, "group", None)] if isinstance(constraint, PairingConstraint) else getattr(constraint, "groups", [])
    )
    return [_members(group, constraint, context) for group in groups]


def _members(group: Element | None, constraint: AffinityConstraint, context: Context) -> Iterable[Element]:
    match group:
        case LabelEntityGroup():
            return group.labels
        case RunnableEntityGroup():
            return group.runnables
        case ProcessEntityGroup():
            return group.processes
        case TagGroup():
            kind = Runnable if isinstance(constraint, RunnableConstraint) else Process
            return [each for each in context.once(_tagged).get(group.tag, []) if isinstance(each, kind)]
    return []


def _tagged(context: Context) -> dict[Tag | None, list[Element]]:
    found: dict[Tag | None, list[Element]] = {}
    for each in context.all(ITaggable):
        for tag in each.tags:
            found.setdefault(tag, []).append(each)
    return found


def _not_apart(constraint: AffinityConstraint, groups: list[dict[Element, list[Element]]]) -> Iterator[str]:
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


RULE = ModelRule(
    id="DOC-Pairing-Separation",
    title="violated pairing or separation constraint",
    severity=Severity.ERROR,
    target=AffinityConstraint,
    check=_check,
    rationale="Paired objects must share a target, and separated objects must not. The APP4MC documentation requires the "
    "mapping to respect this.",
    remedy="Change the mapping to satisfy the constraint, or change the constraint.",
    fails="""
<swModel>
  <labels name="L"/>
  <labels name="M"/>
</swModel>
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:Memory" name="a"/>
    <modules xsi:type="am:Memory" name="b"/>
  </structures>
</hwModel>
<constraintsModel>
  <affinityConstraints xsi:type="am:DataPairingConstraint" name="C">
    <target xsi:type="am:TargetMemory"/>
    <group xsi:type="am:LabelEntityGroup" labels="L?type=Label M?type=Label"/>
  </affinityConstraints>
</constraintsModel>
<mappingModel>
  <memoryMapping abstractElement="L?type=Label" memory="a?type=Memory"/>
  <memoryMapping abstractElement="M?type=Label" memory="b?type=Memory"/>
</mappingModel>
""",
    edits={'memory="a?type=Memory"': 'memory="b?type=Memory"'},
)
