"""Limits one unit inside of what occurs, written into the text of a model: none of them may ever be met."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from urllib.parse import quote_plus

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
}
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

    def event(self, process: str, change: str) -> str:
        """A reference to an event of a process."""
        name = f"limited {process} {change}"
        identity = f"{quote_plus(name)}?type=ProcessEvent"
        kind = "ISR" if process in self.isrs else "Task"
        self.events[name] = (
            f'<events xsi:type="am:ProcessEvent" xmi:id="{identity}" name="{name}" eventType="{change}" '
            f'entity="{process}?type={kind}"/>'
        )
        return identity

    isrs: frozenset[str] = frozenset()


def limits_of(facts: Facts) -> Iterator[Limit]:
    """Limits one unit inside of what occurs."""
    for found, is_upper in ((facts.greatest, True), (facts.least, False)):
        for key, value in found.items():
            if key[0] == "chain" and (key[2] not in LATENCIES or key[2].startswith("max") != is_upper):
                continue
            # Some later target event always keeps a lower limit of a delay.
            if key[0] == "delay" and not is_upper:
                continue
            judged = found.get((key[0], key[1], JUDGED.get(key[2], key[2])), value)
            limit = _one_inside(judged, is_upper=is_upper)
            if limit is not None:
                yield Limit(f"{' '.join(key[1:])} {'up' if is_upper else 'low'}", key, is_upper, limit, judged)


def _one_inside(value: int, *, is_upper: bool) -> int | None:
    """The limit in whole units next to a value that breaks it."""
    limit = (value - 1) // UNIT * UNIT if is_upper else (value // UNIT + 1) * UNIT
    return limit if limit > 0 else None


def with_limits(text: str, facts: Facts, limits: list[Limit]) -> str:
    """The text of a model with further limits."""
    isrs = frozenset(process.name for process in facts.played.processes if process.is_isr)
    added = _Text({}, [], [], isrs)
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
    if kind == "delay":
        bound = f"<{'upper' if limit.is_upper else 'lower'} {time}/>"
        source, target = text.event(*subject.split()), text.event(*quantity.split())
        attributes = f'mappingType="Reaction" source="{source}" target="{target}"'
        text.constraints.append(_constraint("DelayConstraint", limit.name, attributes, bound))
    elif kind == "chain":
        type_, side = LATENCIES[quantity]
        attributes = f'scope="{quote_plus(subject)}?type=EventChain" type="{type_}"'
        text.constraints.append(_constraint("EventChainLatencyConstraint", limit.name, attributes, f"<{side} {time}/>"))
    else:
        entity = f"{subject}?type={'ISR' if subject in text.isrs else 'Task'}"
        side = "UpperLimit" if limit.is_upper else "LowerLimit"
        text.requirements.append(
            f'<requirements xsi:type="am:ProcessRequirement" name="{limit.name}" process="{entity}">'
            f'<limit xsi:type="am:TimeRequirementLimit" limitType="{side}" metric="{METRICS[quantity]}"><limitValue {time}/></limit>'
            "</requirements>"
        )
        if quantity == "start_to_start":
            bound = f"<{'upper' if limit.is_upper else 'lower'} {time}/>"
            attributes = f'event="{text.event(subject, "start")}" span="1"'
            text.constraints.append(_constraint("RepetitionConstraint", f"{limit.name} repetition", attributes, bound))


def _constraint(kind: str, name: str, attributes: str, content: str) -> str:
    identity = f"{quote_plus(name)}?type={kind}"
    return (
        f'<timingConstraints xsi:type="am:{kind}" xmi:id="{identity}" name="{name}" {attributes}>{content}</timingConstraints>'
    )
