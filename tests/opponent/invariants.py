"""What holds in every schedule, whatever the system: checked on the rows and the trace of a simulation, without its scheduler."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from opponent.models.facts import horizon
from opponent.models.reading import read
from opponent.simulation import Recording, record
from opponent.systems import PlainSystem
from opponent.to_perf import read_system
from opponent.to_text import to_text

from amalthea_uros.simulate.options import Options
from amalthea_uros.timing.observed.job_times import JobColumn
from amalthea_uros.trace.table import EntityKind, EventKind
from amalthea_uros.units import Duration

_BEGINS = (EventKind.START, EventKind.RESUME, EventKind.POLL_PARKING)
_LEAVES = (EventKind.PREEMPT, EventKind.TERMINATE, EventKind.PARK, EventKind.WAIT)


def violations(plain: PlainSystem, seed: int = 1) -> list[str]:
    """What is wrong in a simulation of a system."""
    text = to_text(plain)
    duration = horizon(read(text))
    run = record(read_system(text), Options(duration=Duration(duration), seed=seed, traced=(0, Duration(duration))))
    return [*_lost_time(run), *_shared_cores(run), *_shared_semaphores(run), *disobeyed_priorities(plain, run)]


def _lost_time(run: Recording) -> Iterator[str]:
    """A job is always in one state; in READY for what is left by the others."""
    last: dict[int, list[int]] = {}
    for row in run.jobs:
        states = sum(row[column] for column in (JobColumn.RUNNING, JobColumn.WAITING, JobColumn.POLLING, JobColumn.PARKING))
        if (
            not row[JobColumn.ACTIVATION] <= row[JobColumn.START] <= row[JobColumn.END]
            or states > row[JobColumn.END] - row[JobColumn.START]
        ):
            yield f"a job is in its states for {states}: {row}"
        before = last.setdefault(row[JobColumn.PROCESS], row)
        if before is not row and row[JobColumn.START] < before[JobColumn.END]:
            yield f"a job starts before the one before it ends: {row}"
        last[row[JobColumn.PROCESS]] = row


def _shared_cores(run: Recording) -> Iterator[str]:
    """A core executes one process at a time."""
    entities, on_core = run.program.entities, {}
    for time, kind, source, _, target, _, _ in run.events:
        if kind in _BEGINS:
            if source in on_core:
                yield f"{entities[target].name} gets a core at {time} that {entities[on_core[source]].name} has"
            on_core[source] = target
        elif kind in _LEAVES and on_core.pop(source, None) != target:
            yield f"{entities[target].name} leaves a core at {time} that it does not have"


def _shared_semaphores(run: Recording) -> Iterator[str]:
    """One process at a time holds a semaphore."""
    holders: dict[int, int] = {}
    for time, kind, source, _, target, _, _ in run.events:
        if kind == EventKind.ASSIGNED:
            if target in holders:
                yield f"{run.program.entities[target].name} is held twice at {time}"
            holders[target] = source
        elif kind == EventKind.RELEASED and holders.pop(target, None) != source:
            yield f"{run.program.entities[target].name} is released at {time} by a process that does not hold it"


def disobeyed_priorities(plain: PlainSystem, run: Recording) -> Iterator[str]:
    """Without semaphores, groups and modes of preemption, the highest priority of the ready processes has the core."""
    policies = set(plain["cores"].values()) <= {"FPP", "OSEK", "RR"}
    is_simple = all(p["preemption"] == "preemptive" for p in plain["processes"]) and not plain["semaphores"]
    if not policies or not is_simple or "'interruptible': False" in repr(plain):
        return
    rank = {p["name"]: (p["kind"] == "isr", p["priority"]) for p in plain["processes"]}
    core_of = {p["name"]: p["core"] for p in plain["processes"]}
    pending: dict[str, int] = defaultdict(int)
    running: dict[str, str] = {}
    before = 0
    for time, kind, _, _, target, _, _ in run.events:
        if time > before:
            yield from _overtaken(before, rank, core_of, pending, running)
            before = time
        entity = run.program.entities[target]
        if entity.kind not in (EntityKind.TASK, EntityKind.ISR):
            continue
        core = core_of[entity.name]
        if kind == EventKind.ACTIVATE:
            pending[entity.name] += 1
        elif kind in _BEGINS:
            running[core] = entity.name
        elif kind in _LEAVES:
            running.pop(core, None)
            pending[entity.name] -= kind == EventKind.TERMINATE


def _overtaken(
    time: int, rank: dict[str, tuple[bool, int]], core_of: dict[str, str], pending: dict[str, int], running: dict[str, str]
) -> Iterator[str]:
    for name, count in pending.items():
        has_core = running.get(core_of[name])
        if count and (has_core is None or rank[has_core] < rank[name]):
            yield f"{name} is ready after {time}, but {has_core} has the core"
