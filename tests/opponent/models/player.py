"""An independent player of models: what can occur does occur, event by event from time 0, in integer picoseconds.

It knows nothing of the product. Choices are made by `Choices`; how a model is to be read, by a `Variant`.
"""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass, field
from heapq import heappop, heappush
from typing import Any, NamedTuple

from opponent.models.arrivals import occurrences
from opponent.models.comparisons import is_true
from opponent.models.reading import Body, Item, Played, Process, UnplayableError
from opponent.models.variants import (
    ACCESSES,
    END_WAITS_AFTER,
    Ceilings,
    Choices,
    Handover,
    Intruders,
    Points,
    Variant,
    items_of_process,
)

NEVER = 10**18
_MOST_STEPS = 200_000


class Mark(NamedTuple):
    """Something that a job does, and within which runnable."""

    change: str
    name: str
    time: int
    runnable: str


@dataclass(slots=True, eq=False)
class Job:
    """A job of a process; times are None as long as they have not come."""

    process: int
    number: int
    core: str
    activated: int
    rank: tuple[int, int]
    deadline: int
    stack: list[list[Any]]
    slice_left: int
    cause: tuple[int, int] | None = None
    remaining: int = 0
    executed: int = 0
    masks: int = 0
    start: int | None = None
    end: int | None = None
    accesses: dict[tuple[str, str], list[int]] = field(default_factory=dict)
    copies: list[str] = field(default_factory=list)
    #: What runnables do: they start, terminate, read and write; with the name of what they access, or their own.
    marks: list[Mark] = field(default_factory=list)
    #: Whether it keeps others off, as far as its mode of preemption has it; a cooperative job also yields after calls up to a depth.
    is_in_section: bool = False
    yields_up_to: int = 0
    #: Semaphores that it holds, since when; and the one that it waits for, since when, and how long it has waited.
    held: dict[str, int] = field(default_factory=dict)
    #: Labels whose data are visible at the end of the period, and whether that is before the end of the job.
    timed: list[str] = field(default_factory=list)
    is_late: bool = False
    awaited: str = ""
    since: int = 0
    waited: int = 0

    def has_more(self) -> bool:
        """Whether anything is left in its text."""
        return any(index < len(body) for body, index, *_ in self.stack)

    def is_before_mask(self) -> bool:
        """Whether a non-interruptible group comes next, which keeps off nobody who arrives at the instant at which it would begin."""
        following = next((body[index] for body, index, *_ in reversed(self.stack) if index < len(body)), None)
        return following is not None and following[0] == "group" and not following[3]

    def has_only(self, kinds: Container[str]) -> bool:
        """Whether nothing but items of some kinds is left in its text."""
        return all(item[0] in kinds for body, index, *_ in self.stack for item in body[index:])

    def next_item(self, now: int) -> Item | None:
        """Take the next item; that a non-interruptible group is left is one, since others can run then."""
        while self.stack:
            top = self.stack[-1]
            if top[1] < len(top[0]):
                top[1] += 1
                return tuple(top[0][top[1] - 1])
            self.stack.pop()
            if top[3]:
                self.marks.append(Mark("terminate", top[3], now, top[3]))
                if len(self.stack) <= self.yields_up_to:
                    return ("point",)
            if top[2]:
                self.masks -= top[2]
                return ("left",)
        return None

    def enter(self, body: Body, masks: int = 0, runnable: str = "") -> None:
        """Continue inside a body, which can be the one of a runnable."""
        self.masks += masks
        self.stack.append([body, 0, masks, runnable])

    @property
    def runnable(self) -> str:
        """The innermost runnable that is executed; "" if it is none."""
        return next((frame[3] for frame in reversed(self.stack) if frame[3]), "")


class Player:
    """Plays a model once."""

    def __init__(self, played: Played, variant: Variant, choices: Choices, until: int) -> None:
        self.played, self.variant, self.choices = played, variant, choices
        self.processes, self.now, self.rank = played.processes, 0, 0
        self.modes = dict(played.modes)
        self.fills = {name: fill for name, (fill, _) in played.channels.items()}
        self.counts: dict[object, int] = {}
        self.queues: list[list[Job]] = [[] for _ in self.processes]
        self.jobs: list[list[Job]] = [[] for _ in self.processes]
        self.lost = [0] * len(self.processes)
        self.running: dict[str, Job | None] = dict.fromkeys(played.cores)
        self.deciding = dict.fromkeys(played.cores, 0)
        self.budgets = {name: server.capacity for name, server in played.servers.items()}
        self.activated_by = {
            name: [i for i, process in enumerate(self.processes) if name in process.stimuli] for name in played.stimuli
        }
        self.ceilings = {name: self._ceiling(name) for name in played.semaphores}
        self.holders: dict[str, Job | None] = dict.fromkeys(played.semaphores)
        self.waiting: dict[str, list[Job]] = {name: [] for name in played.semaphores}
        self.occurred = dict.fromkeys(played.stimuli, 0)
        self.timeline: list[tuple[int, int, int, str]] = []
        for order, stimulus in enumerate(played.stimuli.values()):
            place = -order if variant.last_first else order
            for time in occurrences(stimulus, choices, until):
                heappush(self.timeline, (time, 1, place, stimulus.name))
        for name, server in played.servers.items():
            for time in range(server.period, until, server.period):
                heappush(self.timeline, (time, 0 if variant.polls_early else 2, 0, name))

    def _ceiling(self, semaphore: str) -> tuple[int, int]:
        """The highest priority and the shortest deadline of the users."""
        users = [p for p in self.processes if ("request", semaphore) in items_of_process(self.played, p.name)]
        deadlines = (user.deadline or NEVER for user in users)
        return max((user.priority for user in users), default=0), min(deadlines, default=NEVER)

    def play(self, until: int) -> Player:
        """Play up to a time."""
        for _ in range(_MOST_STEPS):
            self._end_finished()
            if not self.variant.ends_late:
                self._continue_ended()
            self._requeue(at_once=not self.variant.requeue_late)
            self._arrive()
            self._requeue(at_once=True)
            self._settle()
            step = self._step()
            if self.now + step > until:
                return self
            self._pass(step)
        raise UnplayableError("too many steps")

    # Activations.

    def _arrive(self) -> None:
        while self.timeline and self.timeline[0][0] <= self.now:
            _, kind, _, name = heappop(self.timeline)
            if kind == 1:
                self.fire(name, None)
            else:
                self._replenish(name)

    def _replenish(self, name: str) -> None:
        server = self.played.servers[name]
        is_idle = not any(self.queues[i] for i, process in enumerate(self.processes) if process.server == name)
        self.budgets[name] = 0 if "Polling" in server.policy and is_idle else server.capacity

    def fire(self, name: str, cause: tuple[int, int] | None) -> None:
        """An occurrence of a stimulus: condition, modes, activations."""
        stimulus = self.played.stimuli[name]
        self.occurred[name] += 1
        if not is_true(stimulus.condition, self.modes, self.fills) or not self._counts(name, stimulus.counter):
            return
        self.modes.update(stimulus.sets)
        processes = self.activated_by[name]
        for index in reversed(processes) if self.variant.last_first else processes:
            self._activate(index, cause, self._nominal(name))

    def _nominal(self, name: str) -> int:
        """When this occurrence of a stimulus would have been without jitter."""
        given = self.played.stimuli[name].given
        if not self.variant.nominal_deadlines or "jitter" not in given:
            return self.now
        return int(given.get("offset", 0) + (self.occurred[name] - 1) * given["recurrence"])

    def _counts(self, key: object, counter: tuple[int, int] | None) -> bool:
        if counter is None:
            return True
        self.counts[key] = number = self.counts.get(key, 0) + 1
        return number >= max(counter[1], 1) and (number - counter[1]) % counter[0] == 0

    def _activate(self, index: int, cause: tuple[int, int] | None, nominal: int) -> None:
        process = self.processes[index]
        if len(self.queues[index]) >= process.limit:
            self.lost[index] += 1
            return
        self.rank += 1
        is_sliced = self._is_sliced(process)
        body = process.body
        if process.is_isr:
            body = self._with_entry_and_exit(body) if self.played.overhead else body
        elif process.core in self.played.decisions:
            self.deciding[process.core] += self.played.decisions[process.core]
            body = body if self.variant.decides_outside else (*body, ("raw", self.played.decisions[process.core]))
        order = -index if self.variant.last_first else index
        job = Job(
            process=index,
            number=len(self.jobs[index]),
            core=process.core,
            activated=self.now,
            rank=(self.now, self.rank if is_sliced else order),
            deadline=nominal + (process.deadline or NEVER),
            stack=[[body, 0, 0, ""]],
            slice_left=process.slice if is_sliced and process.slice else NEVER,
            cause=cause,
            yields_up_to=self._depth_of_points() if process.mode == "cooperative" else 0,
        )
        self.queues[index].append(job)
        self.jobs[index].append(job)

    def _with_entry_and_exit(self, body: Body) -> Body:
        before, after = (
            self.played.overhead.get(f"isrCategory2Overhead/{when}ExecutionOverhead", 0) for when in ("pre", "post")
        )
        return (("raw", before), *body, ("raw", after))

    def _depth_of_points(self) -> int:
        return {Points.SCHEDULE_POINTS: 0, Points.TOP_CALLS: 1, Points.CALLS: NEVER}[self.variant.points]

    def _is_sliced(self, process: Process) -> bool:
        return not process.is_isr and "RoundRobin" in self.played.policies[process.core]

    # Who runs.

    def _urgency(self, job: Job) -> tuple[Any, ...]:
        """The least one goes first."""
        process = self.processes[job.process]
        policy = self.played.policies.get(process.core, "")
        if process.server is not None:
            return (-self.played.servers[process.server].priority, -process.priority, job.rank)
        with_ceiling = {name: since for name, since in job.held.items() if self.played.semaphores[name]}
        if policy.startswith("EarliestDeadline") and not process.is_isr:
            own = job.deadline
            if self.variant.ceilings is Ceilings.DEADLINE:
                own = min([own, *(since + self.ceilings[name][1] for name, since in with_ceiling.items())])
            return (own, own == job.deadline, job.rank)
        if policy.startswith("DeadlineMonotonic"):
            return (process.deadline, 0, job.rank)
        priority = max([process.priority, *(self.ceilings[name][0] for name in with_ceiling)])
        return (-priority, priority == process.priority, job.rank)

    def _pick(self, core: str) -> Job | None:
        """The job that has the core."""
        ready = [queue[0] for queue in self.queues if queue and queue[0].core == core and not queue[0].awaited]
        masking = [job for job in ready if job.masks]
        isrs = [job for job in ready if self.processes[job.process].is_isr]
        if masking and not (self.variant.unmasked and isrs):
            return masking[0]
        if isrs:
            if self.deciding[core] and not self.variant.decides_below:
                return None
            started = [job for job in isrs if job.start is not None]
            return started[0] if started and self.variant.serial_isrs else min(isrs, key=lambda j: (-self._priority(j), j.rank))
        if self.deciding[core]:
            return None
        ready = self._not_blocked([job for job in ready if self._has_budget(job)])
        if self.played.policies.get(core, "").startswith("EarliestDeadline") and self.variant.ceilings is Ceilings.START:
            ready = [job for job in ready if job.start is not None or self._is_below_ceilings(job)]
        return min(ready, key=self._urgency, default=None)

    def _not_blocked(self, ready: list[Job]) -> list[Job]:
        """Those that non-preemptive and cooperative tasks allow to run."""
        inside = [job for job in ready if job.is_in_section]
        keeping = [job for job in inside if not self._is_cooperative(job)]
        if keeping or not inside:
            return keeping or ready
        if self.variant.intruders is Intruders.NOBODY:
            return inside
        others = [job for job in ready if not self._is_cooperative(job)]
        return [job for job in ready if job in inside or job in others or self._comes_over(inside, others)]

    def _comes_over(self, inside: list[Job], others: list[Job]) -> bool:
        """Whether cooperative jobs may run because tasks that are not cooperative interrupt those inside."""
        if self.variant.intruders is not Intruders.ABOVE_THEM or not others:
            return False
        return min(map(self._urgency, others)) < min(map(self._urgency, inside))

    def _is_below_ceilings(self, job: Job) -> bool:
        """Whether the relative deadline of a job is below the ceilings of all semaphores that are held on its core."""
        held = (name for name, has_ceiling in self.played.semaphores.items() if has_ceiling and self.holders[name] is not None)
        here = [name for name in held if (holder := self.holders[name]) is not None and holder.core == job.core]
        return all((self.processes[job.process].deadline or NEVER) < self.ceilings[name][1] for name in here)

    def _is_cooperative(self, job: Job) -> bool:
        return self.processes[job.process].mode == "cooperative"

    def _priority(self, job: Job) -> int:
        return self.processes[job.process].priority

    def _has_budget(self, job: Job) -> bool:
        server = self.processes[job.process].server
        return server is None or self.budgets[server] > 0

    def _settle(self) -> None:
        """Do what takes no time, until every core executes something or is idle."""
        cores = list(self.played.cores)
        order = cores[::-1] if self.variant.last_first else cores
        is_settled = False
        while not is_settled:
            is_settled = True
            for core in order:
                while (job := self._take(core)) is not None and not job.remaining:
                    self._act(job)
                    is_settled = False
        for name, server in self.played.servers.items():
            if "Polling" in server.policy and not any(
                self.queues[i] for i, process in enumerate(self.processes) if process.server == name
            ):
                self.budgets[name] = 0

    def _take(self, core: str) -> Job | None:
        job, before = self._pick(core), self.running[core]
        if before is not None and before is not job and before.end is None and self.variant.fresh_slice:
            before.slice_left = self.processes[before.process].slice or NEVER
        self.running[core] = job
        if job is not None:
            process = self.processes[job.process]
            job.is_in_section = not process.is_isr and process.mode != "preemptive"
            if job.start is None:
                job.start = self.now
        return job

    def _requeue(self, *, at_once: bool) -> None:
        """Those that used up their slices go to the ends of their queues, with new ones."""
        for job in self.running.values():
            if at_once and job is not None and job.end is None and job.slice_left == 0:
                self.rank += 1
                job.rank, job.slice_left = (self.now, self.rank), self.processes[job.process].slice or NEVER

    # What jobs do.

    def _end_finished(self) -> None:
        """Who has nothing left to do ends, whatever else happens now."""
        for job in self.running.values():
            if job is not None and job.end is None and not job.remaining and not job.has_more():
                self._end(job)

    def _continue_ended(self) -> None:
        """Do what follows executions that end now."""
        for core, job in self.running.items():
            while (
                job is not None
                and job.end is None
                and not job.remaining
                and not job.is_before_mask()
                and self._pick(core) is job
            ):
                self._act(job)

    def _act(self, job: Job) -> None:
        item = job.next_item(self.now)
        if item is None:
            self._end(job)
            return
        getattr(self, f"_do_{item[0]}")(job, *item[1:])
        if self.variant.accesses_last and not job.remaining and not job.awaited and job.has_only(ACCESSES):
            while (item := job.next_item(self.now)) is not None:
                if item[0] in ACCESSES:
                    getattr(self, f"_do_{item[0]}")(job, *item[1:])
        may_end = not (self.variant.end_waits and item is not None and item[0] in END_WAITS_AFTER)
        if may_end and job.end is None and not job.remaining and not job.has_more():
            self._end(job)

    def _end(self, job: Job) -> None:
        job.end = self.now
        job.marks += [Mark("terminate", frame[3], self.now, frame[3]) for frame in reversed(job.stack) if frame[3]]
        for label in dict.fromkeys(job.copies):
            job.accesses.setdefault(("write", label), []).append(self.now)
        for label in dict.fromkeys(job.timed):
            visible = job.activated + self._period(job)
            job.is_late |= visible < self.now
            job.accesses.setdefault(("write", label), []).append(visible)
        self.queues[job.process].remove(job)
        process = self.processes[job.process]
        if self.variant.decides_outside and not process.is_isr:
            self.deciding[process.core] += self.played.decisions.get(process.core, 0)

    def _do_left(self, job: Job) -> None:
        """A group that was not interruptible ends."""

    def _do_raw(self, job: Job, time: int) -> None:
        job.remaining = time

    def _do_execute(self, job: Job, times: dict[str, tuple[int, int, int]]) -> None:
        least, most, tick = times[job.core]
        job.remaining = self.choices.between(least, most) * tick

    def _do_call(self, job: Job, runnable: str, counter: tuple[int, int] | None, key: int) -> None:
        body, condition = self.played.runnables[runnable]
        if is_true(condition, self.modes, self.fills) and self._counts(key, counter):
            job.marks.append(Mark("start", runnable, self.now, runnable))
            job.enter(body, runnable=runnable)

    def _do_group(self, job: Job, body: Body, is_ordered: bool, is_interruptible: bool) -> None:
        inner = list(body)
        if not is_ordered:
            self.choices.rng.shuffle(inner)
        job.enter(tuple(inner), 0 if is_interruptible else 1)

    def _do_switch(self, job: Job, entries: tuple[tuple[Any, Body], ...], default: Body) -> None:
        job.enter(next((body for condition, body in entries if is_true(condition, self.modes, self.fills)), default))

    def _do_chance(self, job: Job, entries: tuple[tuple[float, Body], ...]) -> None:
        job.enter(self.choices.rng.choices([body for _, body in entries], [weight for weight, _ in entries])[0])

    def _do_read(self, job: Job, label: str, implementation: str) -> None:
        time = job.start if implementation == "implicit" and job.start is not None else self.now
        if implementation == "timed":
            time = job.activated if self._period(job) else time
        job.accesses.setdefault(("read", label), []).append(time)
        job.marks.append(Mark("read", label, self.now, job.runnable))

    def _do_write(self, job: Job, label: str, implementation: str) -> None:
        job.marks.append(Mark("write", label, self.now, job.runnable))
        if implementation == "timed":
            job.timed.append(label)
        elif implementation == "implicit":
            job.copies.append(label)
        else:
            job.accesses.setdefault(("write", label), []).append(self.now)

    def _period(self, job: Job) -> int:
        """The period of a job, which only processes with one periodic stimulus have."""
        stimuli = [self.played.stimuli[name] for name in self.processes[job.process].stimuli]
        if len(stimuli) != 1 or stimuli[0].kind != "Periodic" or "jitter" in stimuli[0].given:
            raise UnplayableError("accesses at the ends of periods that there are not")
        return int(stimuli[0].given["recurrence"])

    def _do_mode(self, job: Job, label: str, access: str, value: int) -> None:
        job.accesses.setdefault(("read" if access == "read" else "write", label), []).append(self.now)
        if access == "set":
            self.modes[label] = value
        elif access in ("increment", "decrement"):
            self.modes[label] += value if access == "increment" else -value

    def _do_send(self, job: Job, channel: str, elements: int) -> None:
        job.accesses.setdefault(("write", channel), []).append(self.now)
        self.fills[channel] = min(self.fills[channel] + elements, self.played.channels[channel][1])

    def _do_receive(self, job: Job, channel: str, taken: int) -> None:
        job.accesses.setdefault(("read", channel), []).append(self.now)
        self.fills[channel] = max(self.fills[channel] - taken, 0)

    def _do_trigger(self, job: Job, stimulus: str, counter: tuple[int, int] | None, key: int) -> None:
        if not self._counts(key, counter):
            return
        overhead = self.played.overhead.get("apiOverhead/apiActivateTask", 0)
        if overhead and not self.variant.fires_first:
            job.enter((("raw", overhead), ("fire", stimulus)))
            return
        job.remaining = overhead
        self._do_fire(job, stimulus)

    def _do_fire(self, job: Job, stimulus: str) -> None:
        self.fire(stimulus, (job.process, job.number))

    def _do_event(self, job: Job, event: str) -> None:
        listeners = self.played.listeners.get(event, ())
        for stimulus in reversed(listeners) if self.variant.last_first else listeners:
            self._do_fire(job, stimulus)

    def _do_point(self, job: Job) -> None:
        """Others go first only where the task is cooperative."""
        job.is_in_section = job.is_in_section and not self._is_cooperative(job)

    def _do_request(self, job: Job, semaphore: str) -> None:
        if self.holders[semaphore] is None:
            self._grant(job, semaphore)
        else:
            job.awaited, job.since, job.is_in_section = semaphore, self.now, False
            self.waiting[semaphore].append(job)

    def _grant(self, job: Job, semaphore: str) -> None:
        self.holders[semaphore] = job
        job.held[semaphore] = self.now

    def _do_release(self, job: Job, semaphore: str) -> None:
        del job.held[semaphore]
        self.holders[semaphore] = None
        waiting = self.waiting[semaphore]
        if not waiting:
            return
        if self.variant.handover is Handover.AGAIN:
            woken = list(waiting)
        elif self.variant.handover is Handover.FIRST:
            woken = waiting[:1]
        else:
            woken = [min(waiting, key=self._urgency)]
        for other in woken:
            waiting.remove(other)
            other.awaited, other.waited = "", other.waited + self.now - other.since
            if self.variant.handover is Handover.AGAIN:
                other.stack[-1][1] -= 1
            else:
                self._grant(other, semaphore)

    def _do_migrate(self, job: Job, core: str) -> None:
        job.core = core

    # Time.

    def _step(self) -> int:
        """The time to the next instant at which something can change."""
        steps = [self.timeline[0][0] - self.now] if self.timeline else [NEVER]
        for core, job in self.running.items():
            if job is not None:
                steps += [job.remaining, job.slice_left]
                server = self.processes[job.process].server
                steps += [self.budgets[server]] if server else []
            elif self.deciding[core]:
                steps.append(self.deciding[core])
        return min(steps)

    def _pass(self, step: int) -> None:
        self.now += step
        for core, job in self.running.items():
            if job is None:
                self.deciding[core] = max(0, self.deciding[core] - step)
                continue
            job.remaining -= step
            job.executed += step
            if job.slice_left != NEVER:
                job.slice_left -= step
            server = self.processes[job.process].server
            if server:
                self.budgets[server] -= step


def play(played: Played, variant: Variant, choices: Choices, until: int) -> Player:
    """A play up to a time; what has not ended by then has no end."""
    return Player(played, variant, choices, until).play(until)
