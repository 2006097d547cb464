"""Limits one unit inside of what occurs, written into the text of a model: none of them may ever be met."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from urllib.parse import quote_plus

from opponent.models.constraints import NEVER, Constraint, EventOf, element
from opponent.models.facts import Facts, Key

UNIT = 10**6
METRICS = {
    "response_time": "ResponseTime",
    "start_to_start": "StartToStart",
    "end_to_end": "EndToEnd",
    "end_to_start": "EndToStart",
    "activate_to_activate": "ActivateToActivate",
    "initial_pending_time": "StartDelay",
    "gross_execution_time": "GrossExecutionTime",
    "running_time": "RunningTime",
    "net_execution_time": "NetExecutionTime",
    "ready_time": "ReadyTime",
    "lateness": "Lateness",
}
#: Those that can be negative.
SIGNED = {"lateness"}
#: What limits of reaction and data age judge, and which of them the type of a constraint limits.
LATENCIES = {
    "max_reaction_time": ("Reaction", "maximum"),
    "min_first_to_first": ("Reaction", "minimum"),
    "max_data_age": ("Age", "maximum"),
    "min_last_to_last": ("Age", "minimum"),
}
#: Constraints judge the reduced quantities, which are what a limit must lie inside of.
JUDGED = {"max_reaction_time": "max_reduced_reaction_time", "max_data_age": "max_reduced_data_age"}


@dataclass(frozen=True, slots=True)
class Limit:
    """A limit, and what occurs outside of it."""

    name: str
    key: Key
    is_upper: bool
    limit: int
    observed: int


@dataclass(slots=True)
class _Text:
    """What is added to a model."""

    events: dict[str, str]
    constraints: list[str]
    requirements: list[str]

    isrs: frozenset[str] = frozenset()
    stated: dict[str, Constraint] = field(default_factory=dict)

    def event(self, event: EventOf) -> str:
        """A reference to an event."""
        name = " ".join(("limited", *filter(None, event)))
        kind = {"process": "ProcessEvent", "runnable": "RunnableEvent", "label": "LabelEvent"}[event.kind]
        identity = f"{quote_plus(name)}?type={kind}"
        entity = {"process": self.process(event.name), "runnable": f"{event.name}?type=Runnable"}
        process = f' process="{self.process(event.process)}"' if event.process else ""
        runnable = f' runnable="{event.runnable}?type=Runnable"' if event.runnable and event.kind == "label" else ""
        self.events[name] = (
            f'<events xsi:type="am:{kind}" xmi:id="{identity}" name="{name}" eventType="{event.change}" '
            f'entity="{entity.get(event.kind, f"{event.name}?type=Label")}"{process}{runnable}/>'
        )
        return identity

    def process(self, name: str) -> str:
        return f"{name}?type={'ISR' if name in self.isrs else 'Task'}"


def name_of(key: Key, *, is_upper: bool) -> str:
    """The name of a limit, unlike those of all others."""
    jitter = ["jitter"] if key[0] == "jitter" else []
    return " ".join(filter(None, (*key[1:], *jitter, "up" if is_upper else "low")))


def limits_of(facts: Facts) -> Iterator[Limit]:
    """Limits one unit inside of what occurs."""
    constraints = {constraint.name: constraint for constraint in facts.constraints}
    for found, is_upper in ((facts.greatest, True), (facts.least, False)):
        for key, value in found.items():
            if key[0] == "chain" and (key[2] not in LATENCIES or key[2].startswith("max") != is_upper):
                continue
            # Some later target event always keeps a lower limit of a delay.
            if key[0] == "delay" and not is_upper:
                continue
            if key[0] == "constraint" and not is_upper and not constraints[key[1]].has_lower:
                continue
            judged = found.get((key[0], key[1], JUDGED.get(key[2], key[2])), value)
            unit, least = UNIT, UNIT
            if key[0] == "constraint":
                unit, least = constraints[key[1]].unit, constraints[key[1]].least
            elif key[2] in SIGNED and key[0] == "process":
                least = -NEVER
            limit = (judged - 1) // unit * unit if is_upper else (judged // unit + 1) * unit
            if limit >= least and judged < NEVER:
                yield Limit(name_of(key, is_upper=is_upper), key, is_upper, limit, judged)


def loose_limits_of(facts: Facts) -> Iterator[Limit]:
    """Limits that everything in all plays keeps, in each way to read a constraint."""
    constraints = {constraint.name: constraint for constraint in facts.constraints}
    for key, (least, most) in facts.loose.items():
        unit = constraints[key[1]].unit if key[0] == "constraint" else UNIT
        # The latencies of chains are compared with those of the simulation elsewhere.
        if key[0] == "chain":
            continue
        if key[0] == "constraint" and constraints[key[1]].least == 0 and most > 0:
            continue
        if most < NEVER:
            yield Limit(name_of(key, is_upper=True), key, is_upper=True, limit=-(-most // unit) * unit, observed=most)
        if key[0] == "constraint" and not constraints[key[1]].has_lower:
            continue
        if least is not None and least // unit > 0:
            yield Limit(name_of(key, is_upper=False), key, is_upper=False, limit=least // unit * unit, observed=least)


def with_limits(text: str, facts: Facts, limits: list[Limit]) -> str:
    """The text of a model with further limits."""
    isrs = frozenset(process.name for process in facts.played.processes if process.is_isr)
    added = _Text({}, [], [], isrs, {constraint.name: constraint for constraint in facts.constraints})
    for limit in limits:
        _add(added, limit)
    text = _into(text, "eventModel", "".join(added.events.values()), before="constraintsModel")
    return _into(text, "constraintsModel", "".join((*added.constraints, *added.requirements)), before="mappingModel")


def _into(text: str, section: str, content: str, before: str) -> str:
    if f"</{section}>" not in text:
        return text.replace(f"<{before}>", f"<{section}>{content}</{section}><{before}>", 1)
    if section == "constraintsModel" and "<requirements " in text:
        constraints, separator, requirements = content.partition("<requirements ")
        text = text.replace("<requirements ", constraints + "<requirements ", 1)
        content = separator + requirements
    return text.replace(f"</{section}>", f"{content}</{section}>", 1)


def _add(text: _Text, limit: Limit) -> None:
    kind, subject, quantity = limit.key
    time = f'value="{limit.limit // UNIT}" unit="us"'
    if kind == "constraint":
        stated = text.stated[subject]
        text.constraints.append(stated.text(limit.name, limit.limit, text.event, is_upper=limit.is_upper))
    elif kind == "delay":
        bound = f"<{'upper' if limit.is_upper else 'lower'} {time}/>"
        source, target = text.event(EventOf("process", *subject.split())), text.event(EventOf("process", *quantity.split()))
        attributes = f'mappingType="Reaction" source="{source}" target="{target}"'
        text.constraints.append(element("DelayConstraint", limit.name, attributes, bound))
    elif kind == "chain":
        type_, side = LATENCIES[quantity]
        attributes = f'scope="{quote_plus(subject)}?type=EventChain" type="{type_}"'
        text.constraints.append(element("EventChainLatencyConstraint", limit.name, attributes, f"<{side} {time}/>"))
    elif kind == "jitter":
        # The product's own notion: the limit of a time that is always kept, with a property.
        least = 'value="1" unit="ps"' if quantity == "response_time" else 'value="0" unit="ps"'
        text.requirements.append(
            f'<requirements xsi:type="am:ProcessRequirement" name="{limit.name}" process="{text.process(subject)}">'
            f'<customProperties key="jitter"><value xsi:type="am:Time" {time}/></customProperties>'
            f'<limit xsi:type="am:TimeRequirementLimit" limitType="LowerLimit" metric="{METRICS[quantity]}">'
            f"<limitValue {least}/></limit></requirements>"
        )
    else:
        entity = text.process(subject)
        side = "UpperLimit" if limit.is_upper else "LowerLimit"
        text.requirements.append(
            f'<requirements xsi:type="am:ProcessRequirement" name="{limit.name}" process="{entity}">'
            f'<limit xsi:type="am:TimeRequirementLimit" limitType="{side}" metric="{METRICS[quantity]}"><limitValue {time}/></limit>'
            "</requirements>"
        )
        if quantity == "start_to_start":
            bound = f"<{'upper' if limit.is_upper else 'lower'} {time}/>"
            attributes = f'event="{text.event(EventOf("process", subject, "start"))}" span="1"'
            text.constraints.append(element("RepetitionConstraint", f"{limit.name} repetition", attributes, bound))
