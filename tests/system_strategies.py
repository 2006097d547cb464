"""Random systems: every class and every field of the generic performance model, with references that lead somewhere.

Values are drawn by the type of a field; which name a text refers to is told by the table below, written from the descriptions of the
fields.
"""

import dataclasses
import types
import typing
from enum import Enum
from fractions import Fraction

from hypothesis import strategies as st

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf import (
    activities,
    conditions,
    constraints,
    distributions,
    events,
    hardware,
    mapping,
    os,
    software,
    stimuli,
)
from amalthea_uros.perf.system import System

#: Names by kind; objects of a kind take them in this order, references draw from those that exist.
KINDS = {
    "clock": [hardware.Clock],
    "core type": [hardware.CoreType],
    "core": [hardware.Core],
    "memory": [hardware.Memory],
    "cache": [hardware.Cache],
    "interconnect": [hardware.Interconnect],
    "connection": [hardware.Connection],
    "structure": [hardware.Structure],
    "scheduler": [os.Scheduler],
    "controller": [os.InterruptController],
    "overhead": [os.Overhead],
    "system": [os.OperatingSystem],
    "semaphore": [os.Semaphore],
    "stimulus": [cls for cls in typing.get_args(stimuli.Stimulus) if cls is not stimuli.InterProcess],
    "inter-process stimulus": [stimuli.InterProcess],
    "stimulus clock": list(typing.get_args(stimuli.Clock)),
    "task": [software.Task],
    "isr": [software.Isr],
    "runnable": [software.Runnable],
    "label": [software.Label],
    "channel": [software.Channel],
    "OS event": [software.OsEvent],
    "mode": [software.Mode],
    "mode label": [software.ModeLabel],
    "event": [events.ProcessEvent, events.SemaphoreEvent, events.StimulusEvent],
    "trigger event": [events.RunnableEvent, events.LabelEvent, events.ModeLabelEvent, events.ChannelEvent],
    "custom event": [events.CustomEvent],
    "event set": [events.EventSet],
    "chain": [events.EventChain],
    "constraint": [*typing.get_args(constraints.Constraint), constraints.DataAgeConstraint, constraints.OrderConstraint],
    "requirement": [constraints.Requirement],
    "data group": [constraints.DataGroup],
}
KIND_OF = {cls: kind for kind, classes in KINDS.items() for cls in classes}

EVENTS = ["event", "trigger event", "custom event"]

#: (class or None for all, field) -> kinds to which its text refers.
REFERENCES = {
    (None, "clock"): ["clock"],
    (stimuli.Scenario, "clock"): ["stimulus clock"],
    (hardware.Core, "type"): ["core type"],
    (None, "core"): ["core"],
    (None, "cores"): ["core"],
    (None, "executing_core"): ["core"],
    (None, "memory"): ["memory"],
    (hardware.Access, "path"): ["cache", "interconnect", "connection"],
    (hardware.Connection, "source"): ["core", "interconnect", "cache"],
    (hardware.Connection, "target"): ["memory", "interconnect", "cache"],
    (None, "scheduler"): ["scheduler"],
    (None, "controller"): ["controller"],
    (os.OperatingSystem, "overhead"): ["overhead"],
    (None, "semaphore"): ["semaphore"],
    (None, "stimulus"): ["stimulus", "inter-process stimulus"],
    (None, "stimuli"): ["stimulus", "inter-process stimulus"],
    (activities.Trigger, "stimulus"): ["inter-process stimulus"],
    (events.Segment, "stimulus"): [*EVENTS, "event set"],
    (events.Segment, "response"): [*EVENTS, "event set"],
    (events.EventChain, "stimulus"): [*EVENTS, "event set"],
    (events.EventChain, "response"): [*EVENTS, "event set"],
    (None, "process"): ["task", "isr"],
    (None, "processes"): ["task", "isr"],
    (None, "task"): ["task"],
    (None, "isr"): ["isr"],
    (None, "runnable"): ["runnable"],
    (activities.SenderReceiverAccess, "notifies"): ["runnable"],
    (activities.ServerCall, "result"): ["runnable"],
    (None, "label"): ["label"],
    (activities.ModeAccess, "label"): ["mode label"],
    (conditions.ModeValueIs, "label"): ["mode label"],
    (conditions.ModeAssignment, "label"): ["mode label"],
    (events.ModeLabelEvent, "label"): ["mode label"],
    (conditions.ModeLabelsAre, "first"): ["mode label"],
    (conditions.ModeLabelsAre, "second"): ["mode label"],
    (None, "channel"): ["channel"],
    (constraints.DataGroup, "labels"): ["label"],
    (mapping.Placement, "element"): ["label", "channel"],
    (None, "mode"): ["mode"],
    (None, "events"): EVENTS,
    # Not every event can activate something.
    (stimuli.EventTriggered, "events"): ["trigger event", "custom event"],
    (activities.SetEvent, "events"): ["OS event"],
    (activities.ClearEvent, "events"): ["OS event"],
    (activities.WaitEvent, "events"): ["OS event"],
    (activities.RaiseEvent, "event"): ["custom event"],
    (constraints.DelayConstraint, "source"): EVENTS,
    (constraints.DelayConstraint, "target"): EVENTS,
    (constraints.RepetitionConstraint, "event"): EVENTS,
    (None, "chain"): ["chain"],
    (None, "chains"): ["chain"],
    (constraints.OrderConstraint, "groups"): ["runnable"],
    (activities.Demand, "by_core_type"): ["core type"],
}

#: Texts that are no names.
WORDS = st.sampled_from(["on", "off", "a b", "größer & <kleiner>", "7"])
TIMES = st.one_of(st.integers(0, 10**15), st.integers(1, 10**4).map(lambda ms: ms * 10**9))
#: Numbers whose decimal text is exact.
DECIMALS = st.integers(0, 10**6).map(lambda thousandths: thousandths / 1000)
FREQUENCIES = st.integers(1, 4 * 10**9).map(Fraction)

TIME_FIELDS = {
    *("period", "offset", "min_distance", "length", "distance", "time", "times", "step", "lower", "upper", "shift", "deadline"),
    *("minimum", "maximum", "jitter", "tolerance", "earliest", "latest"),
}
NOT_NEGATIVE = st.integers(0, 10**6)
POSITIVE = st.integers(1, 10**6)
#: Fields that AMALTHEA restricts, or where 0 is the same as nothing.
NUMBERS = {"prescaler": POSITIVE, "users": POSITIVE, "span": POSITIVE, "activation_limit": POSITIVE, "completed": POSITIVE}
NUMBERS |= dict.fromkeys(("count", "occurrences"), POSITIVE)
NUMBERS |= dict.fromkeys(("exceeding", "alpha", "beta"), st.integers(1, 999).map(float))


#: Fields that are tuples of at least one.
NOT_EMPTY = {"times", "points", "steps", "alternatives", "buckets", "values", "branches", "cases", "needs"}


class Drawing:
    """Draws the objects of one system."""

    def __init__(self, draw, most):
        self.draw = draw
        self.names = {kind: [f"{kind} {n}" for n in range(draw(st.integers(1, most)))] for kind in KINDS}
        # Chains must not run in circles: each one may refer to those before it.
        self.chains_so_far = []
        self.in_time, self.distributed = False, int

    def all(self, kind):
        """The objects of a kind, one for each name."""
        return tuple(self.named(kind, name) for name in self.names[kind])

    def named(self, kind, name):
        """An object of a kind."""
        cls = self.draw(st.sampled_from(KINDS[kind]))
        return self.object(cls, name=name)

    def object(self, cls, depth=0, **given):
        """An object with all its fields."""
        hints = typing.get_type_hints(cls)
        values = dict(given)
        for field in dataclasses.fields(cls):
            if field.name not in values and field.name not in ("origin", "locate"):
                values[field.name] = self.value(cls, field.name, hints[field.name], depth)
        if cls is activities.Demand and values["ticks"] is None and not values["by_core_type"]:
            values["ticks"] = distributions.Constant(1)
        if cls is activities.SenderReceiverAccess and values["kind"] is activities.AccessKind.READ:
            values["notifies"] = ()
        if cls is activities.ServerCall:
            # Only some kinds of calls have a result runnable, or wait.
            values["result"] = values["result"] if values["kind"] is activities.ServerCallKind.ASYNCHRONOUS else None
            values["waits"] = values["waits"] or values["kind"] is not activities.ServerCallKind.GET_RESULT
            is_stated = values["kind"] is not activities.ServerCallKind.ASYNCHRONOUS and values["waits"]
            values["waiting"] = values["waiting"] if is_stated else None
        return cls(**values)

    def value(self, cls, name, hint, depth):
        """A value of a type."""
        if isinstance(hint, typing.TypeVar):
            hint = self.distributed
        origin, arguments = typing.get_origin(hint), typing.get_args(hint)
        if origin in (typing.Union, types.UnionType):
            return self.alternative(cls, name, arguments, depth)
        if origin is tuple and arguments[-1] is Ellipsis:
            count = self.draw(st.integers(self.least(cls, name), 2 if depth < 3 else self.least(cls, name)))
            found = tuple(self.value(cls, name, arguments[0], depth + 1) for _ in range(count))
            return tuple(dict.fromkeys(found)) if name == "cores" else found
        if origin is tuple:
            return tuple(self.value(cls, name, argument, depth) for argument in arguments)
        if hint is str:
            return self.text(cls, name)
        if hint is bool:
            return self.draw(st.booleans())
        if hint is int and (cls, name) == (activities.ModeAccess, "step"):
            return self.draw(POSITIVE)
        if name == "deviation":
            return self.draw(POSITIVE)
        if hint is int:
            return self.draw(NUMBERS.get(name, TIMES if name in TIME_FIELDS or self.in_time else NOT_NEGATIVE))
        if hint is float:
            return float(self.draw(NUMBERS[name])) if name in NUMBERS else self.number()
        if hint is Fraction:
            return self.draw(FREQUENCIES)
        if isinstance(hint, type) and issubclass(hint, Enum):
            # A label and an operating system have nothing to inherit their protection from.
            literals = [x for x in hint if x is not activities.Protection.INHERITED or cls is activities.LabelAccess]
            return self.draw(st.sampled_from(literals))
        return self.part(origin or hint, name, depth, *arguments)

    def number(self):
        """A mean or a rate; means of times are whole picoseconds."""
        return self.draw(TIMES) if self.in_time else self.draw(DECIMALS)

    def part(self, cls, name, depth, distributed=None):
        """An object within another one; distributions draw times, whole numbers, or any."""
        if cls.__module__ != distributions.__name__ or cls is distributions.Bucket:
            return self.object(cls, depth + 1)
        before = self.in_time, self.distributed
        self.in_time, self.distributed = name in ("jitter", "distance"), distributed
        found = self.object(cls, depth + 1)
        self.in_time, self.distributed = before
        return found

    def alternative(self, cls, name, arguments, depth):
        """One of several types; what contains itself ends at some depth."""
        usable = [a for a in arguments if a is not Location]
        if depth >= 3:
            leaves = [a for a in usable if a is type(None) or not self.nests(a)]
            usable = leaves or usable
        choice = self.draw(st.sampled_from(usable))
        return None if choice is type(None) else self.value(cls, name, choice, depth)

    @staticmethod
    def nests(cls):
        nested = (activities.Group, activities.Loop, activities.ProbabilitySwitch, activities.Switch, events.Segment)
        return cls in (*nested, events.Sequence, events.Parallel)

    def least(self, cls, name):
        """How many there are at least."""
        if (cls, name) == (constraints.OrderConstraint, "groups"):
            return 2
        is_event_access = cls in (activities.SetEvent, activities.ClearEvent, activities.WaitEvent)
        is_sequence = name == "items" and cls in (events.Sequence, events.Parallel)
        return int(is_event_access or is_sequence or name in NOT_EMPTY)

    def text(self, cls, name):
        """A name that exists, or some words."""
        kinds = REFERENCES.get((cls, name)) or REFERENCES.get((None, name))
        if cls is events.ChainReference:
            return self.draw(st.sampled_from(self.chains_so_far or self.names["chain"]))
        if kinds:
            return self.draw(st.sampled_from([found for kind in kinds for found in self.names[kind]]))
        if name == "policy":
            return self.draw(st.sampled_from([*os.Policy, "Some other policy"]))
        if name == "name" and cls is not os.Parameter:
            return self.draw(st.sampled_from(["", "a name"]))
        return self.draw(WORDS)


@st.composite
def systems(draw, most=2):
    """A system with up to `most` objects of each kind."""
    d = Drawing(draw, most)
    controllers, schedulers = list(d.all("controller")), list(d.all("scheduler"))
    half = draw(st.integers(0, len(schedulers)))
    names = d.names["system"]
    return System(
        hardware=hardware.Hardware(clocks=d.all("clock"), core_types=_core_types(d), structures=_structures(d)),
        os=os.Os(
            systems=tuple(
                d.object(
                    os.OperatingSystem,
                    name=name,
                    schedulers=tuple(schedulers[:half] if index == 0 else schedulers[half:] if index == 1 else ()),
                    interrupt_controllers=tuple(controllers if index == 0 else ()),
                )
                for index, name in enumerate([*names, "one more system"][:2])
            ),
            overheads=tuple(_overhead(d, name) for name in d.names["overhead"]),
            semaphores=d.all("semaphore"),
        ),
        stimuli=stimuli.Stimuli(stimuli=(*d.all("stimulus"), *d.all("inter-process stimulus")), clocks=d.all("stimulus clock")),
        software=software.Software(
            tasks=d.all("task"),
            isrs=d.all("isr"),
            runnables=d.all("runnable"),
            labels=d.all("label"),
            channels=d.all("channel"),
            os_events=d.all("OS event"),
            modes=d.all("mode"),
            mode_labels=d.all("mode label"),
        ),
        mapping=d.object(mapping.Mapping),
        events=events.Events(
            events=tuple(event for kind in (*EVENTS, "event set") for event in d.all(kind)), chains=_chains(d)
        ),
        constraints=_constraints(d),
    )


def _core_types(d):
    """Core types; a feature of a category has a name of its own for each value."""
    found = []
    for kind in d.all("core type"):
        features = {(f.category, f.value): f for f in kind.features}
        renamed = [dataclasses.replace(f, name=f"f{f.value}") for f in features.values()]
        found.append(dataclasses.replace(kind, features=tuple(renamed)))
    return tuple(found)


def _structures(d):
    """All modules in structures, one of which lies in another one."""
    outer, *others = d.names["structure"]
    cores = tuple(dataclasses.replace(core, caches=()) for core in d.all("core"))
    caches = list(d.all("cache"))
    inside = [d.draw(st.booleans()) for _ in caches]
    cores = (dataclasses.replace(cores[0], caches=tuple(c for c, i in zip(caches, inside, strict=True) if i)), *cores[1:])
    inner = hardware.Structure(
        name="inner",
        kind=d.draw(st.sampled_from([None, *hardware.StructureKind])),
        cores=cores,
        caches=tuple(c for c, i in zip(caches, inside, strict=True) if not i),
        interconnects=d.all("interconnect"),
    )
    first = hardware.Structure(name=outer, structures=(inner,), memories=d.all("memory"), connections=d.all("connection"))
    return (first, *(hardware.Structure(name=name) for name in others))


def _overhead(d, name):
    services = d.draw(st.lists(st.sampled_from(os.Service), unique=True, max_size=3))
    ordered = sorted(services, key=list(os.Service).index)
    found = d.object(os.Overhead, name=name, services=())
    return dataclasses.replace(found, services=tuple((service, d.object(activities.Demand)) for service in ordered))


def _chains(d):
    found = []
    for name in d.names["chain"]:
        # The first chain has nothing to refer to.
        items = d.value(events.EventChain, "items", typing.get_type_hints(events.EventChain)["items"], 0) if found else None
        found.append(d.object(events.EventChain, name=name, items=items))
        d.chains_so_far.append(name)
    return tuple(found)


def _constraints(d):
    found = d.all("constraint")
    ages = tuple(c for c in found if isinstance(c, constraints.DataAgeConstraint))
    orders = tuple(c for c in found if isinstance(c, constraints.OrderConstraint))
    timing = tuple(c for c in found if not isinstance(c, constraints.DataAgeConstraint | constraints.OrderConstraint))
    return constraints.Constraints(
        constraints=timing,
        data_ages=tuple(map(_one_kind, ages)),
        orders=orders,
        requirements=tuple(map(_one_object, d.all("requirement"))),
        data_groups=tuple(sorted(d.all("data group"), key=lambda group: group.kind)),
    )


def _one_kind(age):
    """Times or cycles, not both."""
    if age.earliest_cycle is None and age.latest_cycle is None:
        return age
    cycles = {"earliest_cycle": age.earliest_cycle or 0, "latest_cycle": age.latest_cycle or 0}
    return dataclasses.replace(age, earliest=None, latest=None, **cycles)


def _one_object(requirement):
    """A process or a runnable."""
    if requirement.runnable is not None:
        return dataclasses.replace(requirement, process=None)
    return dataclasses.replace(requirement, process=requirement.process or "task 0")
