"""Small models as they are played, read from their text; whatever has no meaning here is refused.

It knows nothing of the product. A body is a tuple of items, and an item a tuple that begins with its kind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any
from urllib.parse import unquote
from xml.etree import ElementTree

from opponent.models.comparisons import Condition, Holds, holds

XSI = "{http://www.w3.org/2001/XMLSchema-instance}type"
UNITS = {"ps": 1, "ns": 10**3, "us": 10**6, "ms": 10**9, "s": 10**12}
HERTZ = {"Hz": 1, "kHz": 10**3, "MHz": 10**6, "GHz": 10**9}

Element = ElementTree.Element
Item = tuple[Any, ...]
Body = tuple[Item, ...]
#: Prescaler and offset; None: every time.
Counter = tuple[int, int] | None


class UnplayableError(Exception):
    """A model has something that the player does not know."""


@dataclass(frozen=True, slots=True)
class Stimulus:
    """When something is activated; `given` holds what its kind states, in picoseconds."""

    name: str
    kind: str
    given: dict[str, Any]
    sets: tuple[tuple[str, int], ...] = ()
    condition: Condition = ()
    counter: Counter = None


@dataclass(frozen=True, slots=True)
class Server:
    """A budget that the tasks of a scheduler share."""

    policy: str
    core: str
    priority: int
    capacity: int
    period: int


@dataclass(frozen=True, slots=True)
class Process:
    """A task or interrupt service routine on a core."""

    name: str
    is_isr: bool
    stimuli: tuple[str, ...]
    body: Body
    core: str
    mode: str
    priority: int = 0
    deadline: int | None = None
    slice: int | None = None
    limit: int = 1
    server: str | None = None


@dataclass(frozen=True, slots=True)
class Played:
    """A model; cores have frequencies, policies and, for each decision, overheads in picoseconds."""

    cores: dict[str, Fraction]
    policies: dict[str, str]
    decisions: dict[str, int]
    servers: dict[str, Server]
    processes: tuple[Process, ...]
    runnables: dict[str, tuple[Body, Condition]]
    stimuli: dict[str, Stimulus]
    modes: dict[str, int]
    channels: dict[str, tuple[int, int]]
    listeners: dict[str, tuple[str, ...]]
    overhead: dict[str, int] = field(default_factory=dict)
    #: Whether holders of a semaphore have the highest priority of those that use it.
    semaphores: dict[str, bool] = field(default_factory=dict)


def reference(text: str | None) -> str:
    """The name in a reference."""
    return unquote((text or "").partition("?")[0].replace("+", " "))


def references(text: str | None) -> tuple[str, ...]:
    """The names in a list of references."""
    return tuple(map(reference, (text or "").split()))


def time_of(element: Element | None, missing: int | None = 0) -> int | None:
    """A time in picoseconds."""
    if element is None:
        return missing
    if int(element.get("value", "0")) == 0:
        return 0
    return int(element.get("value", "0")) * UNITS[element.get("unit", "")]


def kind_of(element: Element) -> str:
    """The type of an element, without the prefix."""
    return element.get(XSI, "").removeprefix("am:")


def read(text: str | bytes) -> Played:
    """A model from its text."""
    return _Reader(ElementTree.fromstring(text)).played()


class _Reader:
    def __init__(self, root: Element) -> None:
        self.root = root
        domains = {e.get("name"): e for e in root.iter("domains")}
        self.cores = {
            unit.get("name", ""): _frequency(domains[reference(unit.get("frequencyDomain"))])
            for unit in root.iter("modules")
            if kind_of(unit) == "ProcessingUnit"
        }
        self.definition_of = {unit.get("name", ""): reference(unit.get("definition")) for unit in root.iter("modules")}
        self.core_of = {}
        for allocation in root.iter("schedulerAllocation"):
            (self.core_of[reference(allocation.get("scheduler"))],) = references(allocation.get("responsibility"))
        self.schedulers = {e.get("name", ""): e for e in root.iter("taskSchedulers")}
        self.servers = dict(self._servers())

    def played(self) -> Played:
        roots = {name: e for name, e in self.schedulers.items() if name not in self.servers}
        for scheduler in roots.values():
            if scheduler.find("parentAssociation") is not None:
                raise UnplayableError("a scheduler below another one")
        first_core = next(iter(self.cores))
        return Played(
            cores=self.cores,
            policies={self.core_of[name]: reference(e.get("definition")) for name, e in roots.items() if name in self.core_of},
            decisions={
                self.core_of[name]: self._worst(e.find("computationItems"), self.core_of[name])
                for name, e in roots.items()
                if e.find("computationItems") is not None
            },
            servers=self.servers,
            processes=tuple(self._processes()),
            runnables={
                e.get("name", ""): (self._body(e.find("activityGraph")), _condition(e.find("executionCondition")))
                for e in self.root.iter("runnables")
            },
            stimuli={s.name: s for s in map(self._stimulus, self.root.iter("stimuli"))},
            modes={e.get("name", ""): int(e.get("initialValue", "0")) for e in self.root.iter("modeLabels")},
            channels={
                e.get("name", ""): (int(e.get("defaultElements", "0")), int(e.get("maxElements", "0")) or 10**9)
                for e in self.root.iter("channels")
            },
            listeners=self._listeners(),
            overhead=self._overhead(first_core),
            semaphores={e.get("name", ""): e.get("priorityCeilingProtocol") == "true" for e in self.root.iter("semaphores")},
        )

    def _servers(self) -> Iterator[tuple[str, Server]]:
        for name, scheduler in self.schedulers.items():
            parent = scheduler.find("parentAssociation")
            if parent is None:
                continue
            given = dict(_parameters(parent)) | dict(_parameters(scheduler))
            if not {"priority", "capacity", "period"} <= set(given):
                raise UnplayableError("a scheduler below another one")
            core = self.core_of[reference(parent.get("parent"))]
            policy = reference(scheduler.get("definition"))
            yield name, Server(policy, core, given["priority"], given["capacity"], given["period"])

    def _processes(self) -> Iterator[Process]:
        tasks = {e.get("name", ""): e for e in self.root.iter("tasks")}
        isrs = {e.get("name", ""): e for e in self.root.iter("isrs")}
        allocated: dict[str, Process] = {}
        for allocation in self.root.iter("taskAllocation"):
            name, scheduler = reference(allocation.get("task")), reference(allocation.get("scheduler"))
            server = self.servers.get(scheduler)
            given, task = dict(_parameters(allocation)), tasks[name]
            if name in allocated or allocation.get("affinity"):
                raise UnplayableError("several cores")
            allocated[name] = Process(
                name=name,
                is_isr=False,
                stimuli=references(task.get("stimuli")),
                body=self._body(task.find("activityGraph")),
                core=server.core if server else self.core_of[scheduler],
                mode=task.get("preemption", "preemptive"),
                priority=given.get("priority", 0),
                deadline=given.get("deadline"),
                slice=given.get("timeSliceLength"),
                limit=int(task.get("multipleTaskActivationLimit", "0")) or 1,
                server=scheduler if server else None,
            )
        for allocation in self.root.iter("isrAllocation"):
            name = reference(allocation.get("isr"))
            allocated[name] = Process(
                name=name,
                is_isr=True,
                stimuli=references(isrs[name].get("stimuli")),
                body=self._body(isrs[name].find("activityGraph")),
                core=self.core_of[reference(allocation.get("controller"))],
                mode="preemptive",
                priority=int(allocation.get("priority", "0")),
                limit=10**6,
            )
        missing = set(tasks) | set(isrs)
        if missing != set(allocated):
            raise UnplayableError("a process without an allocation")
        yield from (allocated[name] for name in (*tasks, *isrs))

    # Bodies.

    def _body(self, element: Element | None) -> Body:
        """The items of a graph, of a group or of a branch."""
        return () if element is None else tuple(self._item(item) for item in element.findall("items"))

    def _item(self, item: Element) -> Item:
        known: dict[str, Callable[[Element], Item]] = {
            "Ticks": lambda e: ("execute", self._ticks(e)),
            "RunnableCall": lambda e: ("call", reference(e.get("runnable")), _counter(e), id(e)),
            "Group": lambda e: ("group", self._body(e), e.get("ordered") != "false", e.get("interruptible") != "false"),
            "Switch": lambda e: (
                "switch",
                tuple((_condition(entry.find("condition")), self._body(entry)) for entry in e.findall("entries")),
                self._body(e.find("defaultEntry")),
            ),
            "ProbabilitySwitch": lambda e: (
                "chance",
                tuple((float(entry.get("probability", "0")), self._body(entry)) for entry in e.findall("entries")),
            ),
            "LabelAccess": _label_access,
            "ModeLabelAccess": lambda e: (
                "mode",
                reference(e.get("data")),
                e.get("access"),
                int(e.get("value", e.get("step", "1"))),
            ),
            "ChannelSend": lambda e: ("send", reference(e.get("data")), int(e.get("elements", "1"))),
            "ChannelReceive": lambda e: (
                "receive",
                reference(e.get("data")),
                int(e.get("elements", "1")) if e.get("receiveOperation", "").endswith("Take") else 0,
            ),
            "InterProcessTrigger": lambda e: ("trigger", reference(e.get("stimulus")), _counter(e), id(e)),
            "CustomEventTrigger": lambda e: ("event", reference(e.get("event"))),
            "SemaphoreAccess": lambda e: (e.get("access"), reference(e.get("semaphore"))),
            "SchedulePoint": lambda _: ("point",),
            "EnforcedMigration": lambda e: ("migrate", self.core_of[reference(e.get("resourceOwner"))]),
        }
        kind = kind_of(item)
        if kind not in known:
            raise UnplayableError(f"items of the type {kind}")
        return known[kind](item)

    def _ticks(self, item: Element) -> dict[str, tuple[int, int, int]]:
        """By core: the least and the greatest number of ticks, and the picoseconds of one."""
        extended = {reference(e.get("key")): e.find("value") for e in item.findall("extended")}
        found = {}
        for core, frequency in self.cores.items():
            value = extended.get(self.definition_of.get(core, ""), item.find("default"))
            if value is not None:
                found[core] = (*_bounds(value), _whole(10**12 / frequency))
        return found

    def _worst(self, item: Element | None, core: str) -> int:
        if item is None:
            return 0
        _, most, tick = self._ticks(item)[core]
        return most * tick

    def _listeners(self) -> dict[str, tuple[str, ...]]:
        """The stimuli that an event fires."""
        found: dict[str, tuple[str, ...]] = {}
        kinds = {e.get("name", ""): kind_of(e) for e in self.root.iter("events")}
        for stimulus in self.root.iter("stimuli"):
            for event in references(stimulus.get("triggeringEvents")):
                if kinds.get(event) != "CustomEvent":
                    raise UnplayableError("stimuli by events that are not raised")
                found[event] = (*found.get(event, ()), stimulus.get("name", ""))
        return found

    def _overhead(self, core: str) -> dict[str, int]:
        found = {}
        for overhead in self.root.iter("osOverheads"):
            for group in overhead:
                for entry in group:
                    found[f"{group.tag}/{entry.tag}"] = self._worst(entry, core)
        known = {
            "apiOverhead/apiActivateTask",
            "isrCategory2Overhead/preExecutionOverhead",
            "isrCategory2Overhead/postExecutionOverhead",
        }
        if set(found) - known or (found and len({*self.cores.values()}) > 1):
            raise UnplayableError("such overheads")
        return found

    def _stimulus(self, element: Element) -> Stimulus:
        kind = kind_of(element).removesuffix("Stimulus")
        return Stimulus(
            name=element.get("name", ""),
            kind=kind,
            given=_arrivals(element, kind),
            sets=tuple(
                (reference(e.get("label")), int(e.get("value", "0"))) for e in element.iterfind("setModeValueList/entries")
            ),
            condition=_condition(element.find("executionCondition")),
            counter=_counter(element),
        )


def _arrivals(e: Element, kind: str) -> dict[str, Any]:
    plain = {"occurrence", "recurrence", "offset", "burstLength", "occurrenceMinDistance", "minDistance", "step"}
    given: dict[str, Any] = {child.tag: time_of(child) for child in e if child.tag in plain}
    if (jitter := e.find("jitter")) is not None:
        given["jitter"] = _times(jitter)
    if (distance := e.find("nextOccurrence")) is not None:
        given["distance"] = _times(distance)
    if (rate := e.find("occurrencesPerStep")) is not None:
        given["rate"] = tuple(float(rate.get(name, "")) for name in ("lowerBound", "upperBound"))
    if kind == "PeriodicSynthetic":
        given["times"] = [time_of(child) for child in e.findall("occurrenceTimes")]
    if kind == "PeriodicBurst":
        given["count"] = int(e.get("occurrenceCount", "0"))
    if kind == "ArrivalCurve":
        given["curve"] = [
            (
                int(entry.get("numberOfOccurrences", "0")),
                time_of(entry.find("lowerTimeBorder")),
                time_of(entry.find("upperTimeBorder"), None),
            )
            for entry in e.findall("entries")
        ]
    return given


def _times(element: Element) -> tuple[int, int]:
    if kind_of(element) == "TimeConstant":
        value = time_of(element.find("value")) or 0
        return value, value
    lower, upper = time_of(element.find("lowerBound"), None), time_of(element.find("upperBound"), None)
    if lower is None or upper is None:
        raise UnplayableError("times without bounds")
    return lower, upper


def _bounds(value: Element) -> tuple[int, int]:
    if kind_of(value) == "DiscreteValueConstant":
        return (int(value.get("value", "0")),) * 2
    lower, upper = value.get("lowerBound"), value.get("upperBound")
    if lower is None or upper is None:
        raise UnplayableError("values without bounds")
    return int(lower), int(upper)


def _label_access(e: Element) -> Item:
    if e.get("access") not in ("read", "write"):
        raise UnplayableError("such accesses to labels")
    return (e.get("access"), reference(e.get("data")), e.get("implementation", "explicit"))


def _counter(e: Element) -> Counter:
    counter = e.find("counter")
    return None if counter is None else (int(counter.get("prescaler", "1")), int(counter.get("offset", "0")))


def _condition(element: Element | None) -> Condition:
    """Alternatives, each a conjunction of comparisons."""
    if element is None:
        return ()
    found = []
    for entry in element.findall("entries"):
        inner = entry.findall("entries") if kind_of(entry) == "ConditionConjunction" else [entry]
        found.append(tuple(map(_comparison, inner)))
    return tuple(found)


def _comparison(e: Element) -> Holds:
    relation = e.get("relation", "")
    match kind_of(e):
        case "ModeValueCondition":
            return holds("mode", reference(e.get("label")), relation, int(e.get("value", "0")))
        case "ChannelFillCondition":
            return holds("fill", reference(e.get("channel")), relation, int(e.get("fillLevel", "0")))
    raise UnplayableError(f"conditions of the type {kind_of(e)}")


def _frequency(domain: Element) -> Fraction:
    value = domain.find("defaultValue")
    if value is None:
        raise UnplayableError("a core without a frequency")
    return Fraction(value.get("value", "0")) * HERTZ[value.get("unit", "")]


def _whole(time: Fraction) -> int:
    if time.denominator != 1:
        raise UnplayableError("times between picoseconds")
    return int(time)


def _parameters(element: Element) -> Iterator[tuple[str, int]]:
    for parameter in element.findall("schedulingParameters"):
        value = parameter.find("value")
        if value is not None:
            found = time_of(value) if kind_of(value) == "Time" else int(value.get("value", "0"))
            yield reference(parameter.get("key")), found or 0
