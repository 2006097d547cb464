"""Tables of events from rows, what tables say, and random traces that obey the state charts of BTF."""

import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from random import Random

import numpy as np

from amalthea_uros.diagnostics import Finding
from amalthea_uros.trace.readers import open_trace
from amalthea_uros.trace.sinks import open_sink
from amalthea_uros.trace.table import NO_NOTE, Entity, EntityKind, EventKind, EventTable
from amalthea_uros.trace.vocabulary import OS_EVENTS

DTYPES = (np.int64, np.int16, np.int32, np.int64, np.int32, np.int64, np.int64)


def table(entities: Sequence[Entity], rows: Sequence[tuple]) -> EventTable:
    """A table of rows: time, kind, source, source instance, target, target instance, maybe a note."""
    complete = [(*row, NO_NOTE)[:7] for row in rows]
    columns = zip(*complete, strict=True) if rows else [()] * 7
    return EventTable(entities, *(np.array(column, dtype) for column, dtype in zip(columns, DTYPES, strict=True)))


def said(tables: EventTable | Iterable[EventTable]) -> list[tuple]:
    """The events with the entities instead of their indices, which files need not keep."""
    rows = []
    for part in [tables] if isinstance(tables, EventTable) else tables:
        for time, kind, source, job, target, instance, note in zip(*(c.tolist() for c in part.to_dict().values()), strict=True):
            owner = kind in OS_EVENTS and note != NO_NOTE
            entities = part.entities
            rows.append((time, kind, entities[source], job, entities[target], instance, entities[note] if owner else note))
    return rows


def encoded(suffix: str, *tables: EventTable) -> bytes:
    """The file of some tables in the format of a suffix."""
    stream = io.BytesIO()
    with open_sink(stream, tables[0].entities, suffix=suffix) as sink:
        for part in tables:
            sink.write(part)
    return stream.getvalue()


def other_btf(text: str, *, is_numeric: bool = True, is_in_nanoseconds: bool = False) -> str:
    """A BTF file as other tools write it: with numbers for types and entities, or in nanoseconds."""
    names: dict[str, str] = {}
    kinds = {kind.value: str(number) for number, kind in enumerate(EntityKind)} if is_numeric else {}
    lines = []
    for line in text.removesuffix("\n").split("\n"):
        if is_in_nanoseconds and line == "#timescale ps":
            lines.append("#timescale ns")
        elif is_numeric and line.startswith("#entityTypeMapping "):
            _, kind, name = line.split(" ", 2)
            names[name] = str(len(names))
            lines += [f"#typeMapping {kinds[kind]} {kind}", f"#entityMapping {names[name]} {name}"]
            lines.append(f"#entityTypeMapping {kinds[kind]} {names[name]}")
        elif line.startswith("#"):
            lines.append(line)
        else:
            time, source, job, kind, target, *rest = line.split(",")
            ends = (names.get(source, source), job, kinds.get(kind, kind), names.get(target, target))
            rest[2:] = [names.get(note, note) for note in rest[2:]] if kind == EntityKind.OS_EVENT else rest[2:]
            lines.append(",".join((str(int(time) // 1000) if is_in_nanoseconds else time, *ends, *rest)))
    return "".join(f"{line}\n" for line in lines)


def decoded(path: Path, content: str | bytes) -> tuple[list[tuple], tuple[Finding, ...]]:
    """The events of a file with this content, and what is found in it."""
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    reader = open_trace(path)
    return said(list(reader)), reader.findings


def chunks(whole: EventTable, size: int) -> list[EventTable]:
    return [whole.rows(first, first + size) for first in range(0, len(whole), size)]


class Walk:
    """Walks through the state charts of two tasks, an ISR and two cores at random."""

    CORES, TASKS, STIMULI, RUNNABLES, LABEL, OS_EVENT = (0, 1), (2, 3, 4), (5, 6, 7), (8, 9), 10, 11

    def __init__(self, random: Random, names: Sequence[str] = tuple("ABCDEFGHIJKL"), unit: int = 1):
        kinds = [EntityKind.CORE] * 2 + [EntityKind.TASK] * 2 + [EntityKind.ISR] + [EntityKind.STIMULUS] * 3
        kinds += [EntityKind.RUNNABLE] * 2 + [EntityKind.LABEL, EntityKind.OS_EVENT]
        self.entities = [Entity(kind, name) for kind, name in zip(kinds, names, strict=True)]
        self.random = random
        self.unit = unit
        self.time = 0
        self.rows = []
        self.state = dict.fromkeys(self.TASKS, "terminated")
        self.instance = dict.fromkeys((*self.TASKS, *self.STIMULI, *self.RUNNABLES), -1)
        self.stack = {task: [] for task in self.TASKS}
        self.core = {}

    def rows_of(self, steps: int) -> list[tuple]:
        for _ in range(steps):
            self.time += self.random.choice([0, 0, 1, 7, 10**6]) * self.unit
            task = self.random.choice(self.TASKS)
            self.random.choice(self.actions(task))(task)
        return self.rows

    def actions(self, task):
        state = self.state[task]
        has_core = len(self.core) < len(self.CORES)
        match state:
            case "terminated":
                return [self.activate, self.lose]
            case "active":
                return [self.on(EventKind.START, "running")] if has_core else [self.idle]
            case "ready":
                return [self.on(EventKind.RESUME, "running")] if has_core else [self.idle]
            case "running":
                ends = [self.terminate_runnable] if self.stack[task] else [self.off(EventKind.TERMINATE, "terminated")]
                passive = [self.off(EventKind.PREEMPT, "ready"), self.wait, self.stay(EventKind.POLL, "polling")]
                return [*ends, *ends, *passive, self.start_runnable, self.access]
            case "polling":
                return [self.stay(EventKind.RUN, "running"), self.off(EventKind.PARK, "parking")]
            case "parking":
                release = self.leave(EventKind.RELEASE_PARKING)
                return [release, self.on(EventKind.POLL_PARKING, "polling")] if has_core else [release]
            case "waiting":
                return [self.leave(EventKind.RELEASE)]
        raise AssertionError(state)

    def emit(self, *row):
        self.rows.append((self.time, *row))

    def idle(self, task):
        pass

    def trigger(self, task):
        stimulus = task + 3
        self.instance[stimulus] += 1
        self.instance[task] += 1
        number = self.instance[stimulus]
        self.emit(EventKind.TRIGGER, stimulus, number, stimulus, number)
        return stimulus, number, task, self.instance[task]

    def activate(self, task):
        self.emit(EventKind.ACTIVATE, *self.trigger(task))
        self.state[task] = "active"

    def lose(self, task):
        self.emit(EventKind.ACTIVATION_LOST, *self.trigger(task))

    def process_event(self, kind, task, core):
        self.emit(kind, core, 0, task, self.instance[task])

    def on(self, kind, state):
        def act(task):
            core = self.random.choice([core for core in self.CORES if core not in self.core.values()])
            self.core[task] = core
            self.process_event(kind, task, core)
            for runnable, number in self.stack[task]:
                self.emit(EventKind.RUNNABLE_RESUME, task, self.instance[task], runnable, number)
            self.state[task] = state

        return act

    def off(self, kind, state):
        def act(task):
            for runnable, number in reversed(self.stack[task]):
                self.emit(EventKind.RUNNABLE_SUSPEND, task, self.instance[task], runnable, number)
            self.process_event(kind, task, self.core.pop(task))
            self.state[task] = state

        return act

    def stay(self, kind, state):
        def act(task):
            self.process_event(kind, task, self.core[task])
            self.state[task] = state

        return act

    def leave(self, kind):
        def act(task):
            self.process_event(kind, task, self.random.choice(self.CORES))
            self.state[task] = "ready"

        return act

    def wait(self, task):
        self.emit(EventKind.WAIT_EVENT, task, self.instance[task], self.OS_EVENT, 0, task)
        self.off(EventKind.WAIT, "waiting")(task)

    def start_runnable(self, task):
        runnable = self.random.choice(self.RUNNABLES)
        self.instance[runnable] += 1
        self.stack[task].append((runnable, self.instance[runnable]))
        self.emit(EventKind.RUNNABLE_START, task, self.instance[task], runnable, self.instance[runnable])

    def terminate_runnable(self, task):
        self.emit(EventKind.RUNNABLE_TERMINATE, task, self.instance[task], *self.stack[task].pop())

    def access(self, task):
        kind = self.random.choice([EventKind.READ, EventKind.WRITE])
        self.emit(kind, task, self.instance[task], self.LABEL, 0, self.random.choice([NO_NOTE, -3, 0, 2**40]))


def random_trace(random: Random, steps: int = 60, **options) -> EventTable:
    walk = Walk(random, **options)
    return table(walk.entities, walk.rows_of(steps))


def told(tables: Iterable[EventTable]) -> list[str]:
    """The events as short texts: time in ns, kind, job and, unless it is a core or the same, its source."""
    lines = []
    for time, kind, source, job, target, instance, note in said(tables):
        cause = "" if source == target or source.kind is EntityKind.CORE else f" by {source.name}#{job}"
        step = f" step {note}" if kind == EventKind.CHAIN_STEP else ""
        what = "" if kind == EventKind.GAP else f" {target.name}#{instance}"
        lines.append(f"{time / 1000:.12g} {EventKind(kind).name.lower()}{what}{cause}{step}")
    return lines
