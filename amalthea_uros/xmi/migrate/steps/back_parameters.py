"""2.0.0 -> 1.2.0, scheduling parameters: what 1.2.0 has is stated there, anything else becomes custom properties."""

from __future__ import annotations

import re
from collections.abc import Callable

from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.kept import keep, strings
from amalthea_uros.xmi.migrate.steps.restored import ParameterKeys
from amalthea_uros.xmi.migrate.steps.scheduling_definitions import (
    BUDGETS,
    EXTENDED,
    PRIORITY,
    QUANTIZED,
    QUANTUM,
    USER_SPECIFIC,
)
from amalthea_uros.xmi.migrate.steps.v0_9_parts import keep_comments

#: The algorithms that 1.2.0 has, by the tag of the scheduler.
ALGORITHMS = {
    "taskSchedulers": {
        *("FixedPriorityPreemptive", "FixedPriorityPreemptiveWithBudgetEnforcement", "OSEK", "DeadlineMonotonic"),
        *("RateMonotonic", "LeastLocalRemainingExecutionTimeFirst", "EarliestDeadlineFirst", "PriorityBasedRoundRobin"),
        *("DeferrableServer", "PollingPeriodicServer", "SporadicServer", "ConstantBandwidthServer"),
        *("ConstantBandwidthServerWithCASH", "Grouping", *QUANTIZED),
    },
    "interruptControllers": {"PriorityBased"},
}

_NANOSECONDS = {"ns": 1, "us": 1_000, "ms": 1_000_000, "s": 1_000_000_000}

#: A quantum that 1.2.0 can state so that it comes back: 0 is the default there, which the step up takes for none.
_QUANTUM = re.compile("[1-9][0-9]{0,9}").fullmatch
_LARGEST = 2**31 - 1

_PARAMETER = "schedulingParameterDefinitions"

#: Puts a parameter (holder, name, value) where 1.2.0 has a place for it; whether there is one.
Place = Callable[[Node, str, Node], bool]


def write_defaults(holder: Node, keeper: Node, keys: ParameterKeys, scheduler: Node | None, kind: str, notes: Notes) -> None:
    """State what the defaults of the definitions say, which 1.2.0 does not have; of what can be stated there at all."""
    definition = None if scheduler is None else scheduler.target("definition")
    if definition is None:
        return
    stated = {key.name for node in holder.all("schedulingParameters") if (key := node.target("key")) is not None}
    written = []
    for parameter in definition.references.get(kind, ()):
        default = parameter.child("defaultValue")
        if default is None or parameter.name in stated or not _has_place(parameter.name, default, kind, definition, scheduler):
            continue
        added = holder.add("schedulingParameters")
        added.refer("key", parameter)
        added.add("value", default.type).attributes = dict(default.attributes)
        stated.add(parameter.name)
        written.append(parameter.name)
        notes.defaulted(
            keeper,
            "default of a scheduling parameter: AMALTHEA 1.2.0 does not have it",
            f"{parameter.name} = {_shown(default)}",
        )
    if written:
        keep(keeper, keys.defaults, strings(written, keeper))


def _has_place(name: str, value: Node, kind: str, definition: Node, scheduler: Node | None) -> bool:
    """Whether 1.2.0 has a place for a parameter: found by putting a copy there."""
    copy = Node("value", value.type, dict(value.attributes))
    if kind == "processParameters":
        return place_in_allocation(Node("taskAllocation"), name, copy)
    is_known = scheduler is not None and definition.name in ALGORITHMS.get(scheduler.tag, ())
    return place_in_algorithm(Node("schedulingAlgorithm", definition.name if is_known else USER_SPECIFIC), name, copy)


def change_parameters(holder: Node, keeper: Node, keys: ParameterKeys, place: Place, notes: Notes) -> None:
    """Put the parameters of an allocation, scheduler or association where 1.2.0 has a place for them, else into custom properties."""
    placed: list[str] = []
    others: list[str] = []
    seen: set[str] = set()
    nodes = holder.all("schedulingParameters")
    # The former parts and the new one of 1.2.0 have the same tag.
    remove_all(nodes)
    for node in nodes:
        key, value = node.target("key"), node.child("value")
        problem = _problem(key, value, seen)
        if node.attributes or len(node.children) > 1:
            problem = problem or "scheduling parameter with unknown content"
        if problem or key is None or value is None:
            notes.lost(keeper, problem, name_of(key))
            continue
        name = key.name
        seen.add(name)
        if place(holder, name, value):
            placed.append(name)
            notes.converted(keeper, "scheduling parameter is stated as in AMALTHEA 1.2.0", f"{name} = {_shown(value)}")
            keep_comments(node, holder)
        else:
            others.append(name)
            shown = _shown(value)
            keep(keeper, keys.parameter + name, value).comments = node.comments
            notes.kept(keeper, "scheduling parameter", f"{name} = {shown}")
    order = [name for name in (PRIORITY, *BUDGETS) if name in placed]
    order += [name for name in placed if name not in order] + others
    stated = [key.name for node in nodes if (key := node.target("key")) is not None]
    if order != stated:
        keep(keeper, keys.order, strings(stated, keeper))


def _problem(key: Node | None, value: Node | None, seen: set[str]) -> str:
    """Why a parameter cannot be kept, "" if it can."""
    if key is not None and key.tag != _PARAMETER:
        return "scheduling parameter of which the definition is in none of the files"
    if key is None or not key.name:
        return "scheduling parameter without a definition that has a name"
    if value is None:
        return "scheduling parameter without a value"
    return "scheduling parameter that is stated twice" if key.name in seen else ""


def name_of(key: Node | None) -> str:
    """The name of a definition, also of one that is in none of the files."""
    return "" if key is None else key.name or key.get("path")


def _shown(value: Node) -> str:
    return " ".join(text for name in ("value", "unit") if (text := value.get(name))) or value.type


def place_in_allocation(holder: Node, name: str, value: Node) -> bool:
    """State a parameter in an allocation or association, if 1.2.0 has a place for it."""
    if name == PRIORITY and value.type == "IntegerObject":
        holder.child_or_new("schedulingParameters").attributes["priority"] = value.get("value", "0")
        return True
    if name in BUDGETS and value.type == "Time":
        value.tag, value.type = name, ""
        holder.child_or_new("schedulingParameters").insert(value)
        return True
    return _place_as_extension(holder, name, value)


def place_in_algorithm(algorithm: Node, name: str, value: Node) -> bool:
    """State a parameter in an algorithm, if 1.2.0 has a place for it."""
    if algorithm.type == USER_SPECIFIC:
        return _place_as_extension(algorithm, name, value)
    text = value.get("value")
    factor = _NANOSECONDS.get(value.get("unit"))
    if name != QUANTUM or algorithm.type not in QUANTIZED or value.type != "Time" or not factor or not _QUANTUM(text):
        return False
    if int(text) * factor > _LARGEST:
        return False
    algorithm.attributes["quantSizeNs"] = str(int(text) * factor)
    return True


def _place_as_extension(holder: Node, name: str, value: Node) -> bool:
    if not name.startswith(EXTENDED) or value.type != "StringObject" or "value" not in value.attributes:
        return False
    holder.add("parameterExtensions", like=value, key=name.removeprefix(EXTENDED), value=value.get("value"))
    return True
