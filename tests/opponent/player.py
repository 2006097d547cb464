"""An independent player of systems in the plain form: what can occur does occur.

It knows nothing of the product. Time passes to the next instant at which something can change; at each instant, executions end,
processes are activated, and what takes no time is done until every core executes something or is idle. The choices that a system
leaves open are made by a random generator; how it is to be read, by `Readings`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain
from random import Random
from typing import Any

from opponent.readings import Ceilings, Handover, Instant, Intruders, Points, Readings
from opponent.systems import Item, PlainSystem, items_of

#: What a job does next: an operation that takes no time, or ("execute", duration).
Operation = tuple[str, Any]

NEVER = 10**9
_ENDS = (("called", None), ("point", None), ("mask", -1))
_ACCESSES = ("read", "write")


@dataclass(frozen=True, slots=True)
class Release:
    """An activation, and the time at which it would have been without jitter."""

    time: int
    nominal: int


@dataclass(slots=True, eq=False)
class Job:
    """A job of a process; times are None as long as they have not come."""

    process: int
    release: Release
    deadline: int
    rank: tuple[int, int]
    operations: Iterator[Operation]
    pending: Operation | None = None
    remaining: int = 0
    slice_left: int = NEVER
    start: int | None = None
    end: int | None = None
    waits_for: str | None = None
    waits_since: int = 0
    masks: int = 0
    is_in_section: bool = False
    holds: list[tuple[str, int]] = field(default_factory=list)
    accesses: dict[tuple[str, str], int] = field(default_factory=dict)

    def has_more(self) -> bool:
        """Whether anything is left to do."""
        if self.pending is None:
            self.pending = next(self.operations, None)
        return self.pending is not None

    def is_before_mask(self) -> bool:
        """Whether a non-interruptible group comes next."""
        return self.has_more() and self.pending == ("mask", 1)


class Player:
    """Plays a system once."""

    def __init__(self, system: PlainSystem, readings: Readings, rng: Random, until: int) -> None:
        self.readings, self.rng, self.until = readings, rng, until
        self.processes: list[dict[str, Any]] = system["processes"]
        self.index = {process["name"]: index for index, process in enumerate(self.processes)}
        self.runnables, self.semaphores = system["runnables"], system["semaphores"]
        self.policies = system["cores"]
        self.is_explicit = system.get("chain", {}).get("communication") == "explicit"
        self.on_core = {core: [i for i, p in enumerate(self.processes) if p["core"] == core] for core in self.policies}
        self.counts: dict[object, int] = {}
        self.holders: dict[str, Job | None] = dict.fromkeys(self.semaphores)
        self.waiting: dict[str, list[Job]] = {semaphore: [] for semaphore in self.semaphores}
        self.ceilings = {semaphore: self._ceiling(system, semaphore) for semaphore in self.semaphores}
        self.queues: list[list[Job]] = [[] for _ in self.processes]
        self.ended: list[list[Job]] = [[] for _ in self.processes]
        self.running: dict[str, Job | None] = dict.fromkeys(self.policies)
        self.rank = 0
        self.now = 0
        self.extremes = rng.choice(("any", "any", "best", "worst", "corners"))
        self.releases = sorted(
            ((release, index) for index in range(len(self.processes)) for release in self._releases(index)),
            key=lambda pair: (pair[0].time, -pair[1] if readings.last_first else pair[1]),
            reverse=True,
        )

    # What is open.

    def between(self, least: int, most: int) -> int:
        """A value between two others."""
        if self.extremes == "best":
            return least
        if self.extremes == "worst":
            return most
        if self.extremes == "corners" or self.rng.random() < 0.5:
            return self.rng.choice((least, most))
        return self.rng.randint(least, most)

    def _releases(self, index: int) -> Iterator[Release]:
        arrival, rng = self.processes[index]["arrival"], self.rng
        if "periodic" in arrival:
            given = arrival["periodic"]
            jitter, style = given.get("jitter", 0), rng.choice(("any", "corners", "first late"))
            for number, nominal in enumerate(range(given.get("offset", 0), self.until, given["period"])):
                late = rng.choice((0, jitter)) if style == "corners" else rng.randint(0, jitter)
                if style == "first late":
                    late = jitter if number % 4 == 0 else 0
                yield Release(nominal + late, nominal)
        elif "sporadic" in arrival:
            given = arrival["sporadic"]
            time, style = given["offset"], rng.choice(("any", "dense", "corners"))
            while time < self.until:
                yield Release(time, time)
                least, most = given["least"], given["most"]
                time += (
                    least if style == "dense" else rng.choice((least, most)) if style == "corners" else rng.randint(least, most)
                )

    def _counts(self, key: object, counter: dict[str, int]) -> bool:
        """Whether this occurrence takes effect."""
        if "prescaler" not in counter:
            return True
        self.counts[key] = number = self.counts.get(key, 0) + 1
        return number >= max(counter["offset"], 1) and (number - counter["offset"]) % counter["prescaler"] == 0

    def _operations(self, body: list[Item], process: dict[str, Any], depth: int) -> Iterator[Operation]:
        """What a job does, decided as it is reached."""
        is_cooperative = process["preemption"] == "cooperative" and process["kind"] == "task"
        for item in body:
            if "execute" in item:
                yield ("execute", self.between(*item["execute"]))
            elif "call" in item:
                if self._counts(id(item), item):
                    yield from self._operations(self.runnables[item["call"]], process, depth + 1)
                    points = self.readings.points
                    if is_cooperative and (points is Points.CALLS or (points is Points.TOP_CALLS and depth == 0)):
                        yield ("called", None)
            elif "group" in item:
                yield from self._group(item, process, depth)
            elif "switch" in item:
                weights = [weight for weight, _ in item["switch"]]
                _, branch = self.rng.choices(item["switch"], weights)[0]
                yield from self._operations(branch, process, depth + 1)
            elif "trigger" in item:
                if self._counts(id(item), item):
                    yield ("trigger", item["trigger"])
            elif "point" in item:
                if is_cooperative:
                    yield ("point", None)
            elif self.is_explicit or not ("read" in item or "write" in item):
                yield next(iter(item.items()))

    def _group(self, item: Item, process: dict[str, Any], depth: int) -> Iterator[Operation]:
        inner = list(item["group"])
        if not item.get("ordered", True):
            self.rng.shuffle(inner)
        if item.get("interruptible", True):
            yield from self._operations(inner, process, depth + 1)
        else:
            yield ("mask", 1)
            yield from self._operations(inner, process, depth + 1)
            yield ("mask", -1)

    # Who runs.

    def _ceiling(self, system: PlainSystem, semaphore: str) -> tuple[int, int]:
        """The highest priority and the shortest deadline of the users."""
        users = [
            process
            for process in self.processes
            if any(item.get("request") == semaphore for item in items_of(system, process["body"]))
        ]
        priorities = [user["priority"] for user in users]
        return max(priorities, default=0), min((user.get("deadline", NEVER) for user in users), default=NEVER)

    def _urgency(self, job: Job) -> tuple[Any, ...]:
        """The least one goes first."""
        process = self.processes[job.process]
        boosts = [(s, since) for s, since in job.holds if self.semaphores[s]["ceiling"]]
        policy = self.policies[process["core"]]
        if process["kind"] == "task" and policy == "EDF":
            own = job.deadline
            if self.readings.ceilings is Ceilings.DEADLINE:
                own = min([own, *(since + self.ceilings[s][1] for s, since in boosts)])
            return (own, own == job.deadline, job.rank)
        priority = max([process["priority"], *(self.ceilings[s][0] for s, _ in boosts)])
        return (-priority, priority == process["priority"], job.rank)

    def _pick(self, core: str) -> Job | None:
        """The job that has the core."""
        ready = [self.queues[i][0] for i in self.on_core[core] if self.queues[i]]
        ready = [job for job in ready if job.waits_for is None]
        if len(ready) < 2:
            return self._may_start(core, ready)
        masking = [job for job in ready if job.masks]
        if masking and self.readings.masked:
            return masking[0]
        isrs = [job for job in ready if self.processes[job.process]["kind"] == "isr"]
        if isrs:
            started = [job for job in isrs if job.start is not None]
            return started[0] if started and self.readings.serial_isrs else min(isrs, key=self._urgency)
        return masking[0] if masking else self._may_start(core, self._not_blocked(ready))

    def _may_start(self, core: str, ready: list[Job]) -> Job | None:
        """The most urgent one of those that ceilings under earliest deadline first allow to start."""
        if self.policies[core] == "EDF" and self.readings.ceilings is Ceilings.START:
            ready = [job for job in ready if job.start is not None or self._is_below_ceilings(job)]
        return min(ready, key=self._urgency, default=None)

    def _is_below_ceilings(self, job: Job) -> bool:
        process = self.processes[job.process]
        if process["kind"] == "isr":
            return True
        held = [s for s, holder in self.holders.items() if holder is not None and self.semaphores[s]["ceiling"]]
        here = [s for s in held if self.processes[self.holders[s].process]["core"] == process["core"]]  # type: ignore[union-attr]
        return all(process["deadline"] < self.ceilings[s][1] for s in here)

    def _mode(self, job: Job) -> str:
        return str(self.processes[job.process]["preemption"])

    def _not_blocked(self, ready: list[Job]) -> list[Job]:
        """Those that non-preemptive and cooperative tasks allow to run."""
        inside = [job for job in ready if job.is_in_section]
        for job in inside:
            if self._mode(job) == "non-preemptive":
                return [job]
        if not inside:
            return ready
        if self.readings.intruders is Intruders.NOBODY:
            return inside
        others = [job for job in ready if self._mode(job) != "cooperative"]
        return [job for job in ready if job in inside or job in others or self._comes_over(job, inside, others)]

    def _comes_over(self, job: Job, inside: list[Job], others: list[Job]) -> bool:
        """Whether a cooperative job may run because tasks that are not cooperative interrupt those inside."""
        if self.readings.intruders is not Intruders.ABOVE_THEM or not others:
            return False
        intruder, interrupted = min(others, key=self._urgency), min(inside, key=self._urgency)
        return self._urgency(intruder) < self._urgency(interrupted)

    # What happens.

    def play(self, most: int) -> Player:
        """Play until all jobs have ended, or at most until a time."""
        while self.now < most:
            self._end_executions()
            self._activate_due()
            self._settle()
            step = self._next_step()
            if step is None:
                break
            self._pass(step)
        return self

    def _end_executions(self) -> None:
        for core, job in self.running.items():
            if job is None or job.remaining:
                continue
            if self.readings.instant is Instant.BEFORE_WITH_ACCESSES:
                self._access_now(job)
            if not job.has_more():
                self._end(job)
            elif self.readings.instant in (Instant.BEFORE, Instant.BEFORE_WITH_ACCESSES):
                while self._pick(core) is job and not job.remaining and job.end is None and not job.is_before_mask():
                    self._act(job)

    def _activate_due(self) -> None:
        if not self.readings.requeue_late:
            self._requeue_spent()
        while self.releases and self.releases[-1][0].time <= self.now:
            release, index = self.releases.pop()
            self._activate(index, release)
        self._requeue_spent()

    def _requeue_spent(self) -> None:
        """Those that used up their slices go to the ends of their queues, with new ones."""
        for job in self.running.values():
            if job is not None and job.end is None and job.slice_left == 0:
                self.rank += 1
                job.rank = (self.now, self.rank)
                job.slice_left = self.processes[job.process]["slice"]

    def _activate(self, index: int, release: Release) -> None:
        process = self.processes[index]
        self.rank += 1
        order = -index if self.readings.last_first else index
        is_sliced = process["kind"] == "task" and self.policies[process["core"]] == "RR"
        start = release.nominal if self.readings.nominal_deadlines else release.time
        job = Job(
            process=index,
            release=release,
            deadline=start + process.get("deadline", NEVER),
            rank=(release.time, self.rank if is_sliced else order),
            operations=self._operations(process["body"], process, 0),
            slice_left=process["slice"] if is_sliced else NEVER,
        )
        self.queues[index].append(job)

    def _settle(self) -> None:
        """Do what takes no time, until every core executes something or is idle."""
        is_settled = False
        while not is_settled:
            is_settled = True
            for core in self.policies:
                while True:
                    job = self._pick(core)
                    self._switch(core, job)
                    if job is None or job.remaining:
                        break
                    self._act(job)
                    is_settled = False

    def _switch(self, core: str, job: Job | None) -> None:
        before = self.running[core]
        if before is not None and before is not job and before.end is None and self.readings.fresh_slice:
            before.slice_left = self.processes[before.process].get("slice", NEVER)
        self.running[core] = job
        if job is not None:
            job.is_in_section = self.processes[job.process]["kind"] == "task" and self._mode(job) != "preemptive"
            if job.start is None:
                job.start = self.now

    def _act(self, job: Job) -> None:
        """The next operation of a job."""
        if not job.has_more():
            self._end(job)
            return
        assert job.pending is not None
        kind, argument = job.pending
        if kind == "request" and self.holders[argument] is not None:
            job.waits_for, job.waits_since, job.is_in_section = argument, self.now, False
            self.waiting[argument].append(job)
            return
        job.pending = None
        if kind == "execute":
            job.remaining = argument
        elif kind == "request":
            self._grant(argument, job)
        elif kind == "release":
            self._release(argument, job)
        elif kind == "mask":
            job.masks += argument
        elif kind in ("point", "called"):
            job.is_in_section = False
        elif kind == "trigger":
            index = self.index[argument]
            if self._counts(argument, self.processes[index]["arrival"]["trigger"]):
                self._activate(index, Release(self.now, self.now))
        else:
            job.accesses.setdefault((kind, argument), self.now)
        if (
            kind == "called"
            or (kind == "mask" and argument < 0)
            or (kind in ("release", "trigger", "point") and self.readings.instant is not Instant.END_WAITS)
        ):
            self._end_if_done(job)

    def _end_if_done(self, job: Job) -> None:
        if self.readings.instant is Instant.BEFORE_WITH_ACCESSES:
            self._pass_over(job)
        if not job.has_more():
            self._end(job)

    def _pass_over(self, job: Job) -> None:
        """Do what is left of a job, if that is nothing but accesses, and the ends of calls and groups."""
        left = [job.pending] if job.pending is not None else []
        for operation in job.operations:
            left.append(operation)
            if operation not in _ENDS and operation[0] not in _ACCESSES:
                break
        if all(operation in _ENDS or operation[0] in _ACCESSES for operation in left):
            job.accesses = {operation: self.now for operation in left if operation[0] in _ACCESSES} | job.accesses
            left = []
        job.pending, job.operations = None, chain(left, job.operations)

    def _access_now(self, job: Job) -> None:
        """Do the accesses that follow."""
        while job.has_more() and job.pending is not None and job.pending[0] in _ACCESSES:
            job.accesses.setdefault(job.pending, self.now)
            job.pending = None

    def _grant(self, semaphore: str, job: Job) -> None:
        self.holders[semaphore] = job
        job.holds.append((semaphore, self.now))

    def _release(self, semaphore: str, job: Job) -> None:
        job.holds = [(s, since) for s, since in job.holds if s != semaphore]
        self.holders[semaphore] = None
        waiting = self.waiting[semaphore]
        if not waiting:
            return
        if self.readings.handover is Handover.AGAIN:
            for other in waiting:
                other.waits_for = None
            waiting.clear()
            return
        chosen = min(waiting, key=self._urgency) if self.readings.handover is Handover.URGENT else waiting[0]
        waiting.remove(chosen)
        chosen.waits_for, chosen.pending = None, None
        self._grant(semaphore, chosen)

    def _end(self, job: Job) -> None:
        job.end = self.now
        self.queues[job.process].remove(job)
        self.ended[job.process].append(job)

    def _next_step(self) -> int | None:
        """The time to the next instant at which something can change; None: nothing happens any more."""
        steps = [min(job.remaining, job.slice_left) for job in self.running.values() if job is not None]
        if self.releases:
            steps.append(self.releases[-1][0].time - self.now)
        return min(steps, default=None)

    def _pass(self, step: int) -> None:
        self.now += step
        for job in self.running.values():
            if job is not None:
                job.remaining -= step
                job.slice_left -= step


def play(system: PlainSystem, readings: Readings, rng: Random, until: int) -> list[list[Job]]:
    """The jobs of each process that were activated before a time and ended."""
    return Player(system, readings, rng, until).play(4 * until).ended
