"""Executors that loop, in memory, and the programs of their iterations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.semantics.loops import SLEEP_RESOLUTION, returns_at_once, sleep_of
from amalthea_uros.executors.semantics.readiness import is_message, messages, shares_session, thread_of
from amalthea_uros.executors.semantics.steps import IterationStep, iterations_name, session_lock, steps_of
from amalthea_uros.perf.activities import Activity, Call, ProbabilitySwitch
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.executors import Executor, Handle, HandleKind, LoopKind, Publication, ThreadPlace, TriggerKind
from amalthea_uros.perf.software import Process
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.program.flows import FlowRecords
from amalthea_uros.simulate.program.image import JumpLabel
from amalthea_uros.simulate.program.messages import MessageRecords
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.program.wire_programs import add_parts
from amalthea_uros.simulate.sampling.streams import durations
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.timing.touching import awaited
from amalthea_uros.units import Interval, Time, time_text

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body

#: An assumption.
_OVERHEAD = "the overhead of an iteration of an executor is executed after its wait"


@dataclass(slots=True)
class ExecutorRecords:
    """The records of executors.

    Attributes
    ----------
    records : by name
    measured : the executors and handles whose calls are measured, in the order of their numbers in rows
    """

    resources: Resources
    messages: MessageRecords
    flows: FlowRecords
    first_number: int
    records: dict[str, int] = field(default_factory=dict)
    measured: list[tuple[str, str]] = field(default_factory=list)
    _publications: dict[tuple[str, str, str], int] = field(default_factory=dict)

    def place(self) -> None:
        """Place and fill the records."""
        for executor in self.resources.context.system.executors:
            if executor.task in self.resources.processes:
                self.records[executor.name] = self.resources.image.record(layout.EXECUTOR_SIZE)
                self._fill(executor, self.records[executor.name])
                for handle in executor.handles:
                    if _comes_without_wire(handle) and handle.interval:
                        self.messages.bring_without_wire(executor, handle)

    def _fill(self, executor: Executor, record: int) -> None:
        resources, image, time = self.resources, self.resources.image, self.resources.time
        waiting, loop = executor.waiting, executor.loop
        handles = {handle.name: self.messages.handles[executor.name, handle.name] for handle in executor.handles}
        first, end = image.items(handles.values())
        sets, sets_end = image.items(
            [image.items([*(handles[name] for name in each), 0])[0] for each in _trigger_sets(executor)]
        )
        of_thread = thread_of(executor, resources.context.system.executors)
        following = of_thread[(of_thread.index(executor) + 1) % len(of_thread)]
        begin = self._begin(executor) if executor is self._first_to_end(of_thread) else layout.NEVER
        fields = {
            layout.READER_PROCESS: resources.processes[executor.task],
            layout.INBOX: self.messages.inboxes[executor.name],
            layout.OUT_FLOW: self.flows.out_of(executor.name),
            layout.WAIT_TIMEOUT: time(loop.timeout),
            layout.RESOLUTION: time(waiting.resolution),
            layout.MESSAGES_PER_WAIT: (waiting.messages_per_wait or 0) if messages(executor) else layout.NO_MESSAGE,
            layout.KEPT_END_WAIT: int(waiting.stored_data_ends_wait),
            layout.FLAGS_END_WAIT: int(waiting.guard_conditions_end_wait),
            layout.WAIT_ALARM: self.messages.lines.alarm(layout.END_OF_WAIT, record),
            layout.HANDLES: first,
            layout.HANDLES_END: end,
            layout.TRIGGER_SETS: sets,
            layout.TRIGGER_SETS_END: sets_end,
            layout.SLEEPS: self._sleeps(executor),
            layout.PACE: time(loop.pace),
            layout.LAST_WAKE: -time(loop.pace),
            layout.LOOP_PERIOD: 0 if loop.period is None else time(loop.period),
            layout.INVOCATION: -1,
            layout.SLEEP_RESOLUTION: time(SLEEP_RESOLUTION),
            layout.LOOP_STIMULUS: resources.stimuli[iterations_name(following.name)],
            layout.NEXT_PROCESS: resources.processes.get(following.task, 0),
            layout.LOOP_ALARM: self.messages.lines.alarm(layout.NEXT_ITERATION, record, at=begin),
        }
        image.put(record, fields)

    def _first_to_end(self, of_thread: Sequence[Executor]) -> Executor:
        """The executor of a thread whose pause is the first one: the last one, or if phases are random that with the longest pause."""
        is_random = self.resources.options.mode is SimulationMode.SAMPLED
        return max(reversed(of_thread), key=_pause) if is_random else of_thread[-1]

    def _begin(self, executor: Executor) -> int:
        """When the first pause ends: at random, as its phase against everything else is not known."""
        if self.resources.options.mode is not SimulationMode.SAMPLED:
            return 0
        self.resources.assume_phase()
        return self.resources.time(self.resources.random_phase(f"executor {executor.name}") * _pause(executor) >> 64)

    def _sleeps(self, executor: Executor) -> int:
        """The stream of sleeps; 0 if it does not sleep."""
        sleep = sleep_of(executor) if executor.place is None else _sleep_at(executor.place)
        if executor.loop.kind is not LoopKind.SLEEPING or not sleep.upper:
            return 0
        source = RandomSource(self.resources.options.seed, f"sleep of {executor.name}")
        times = Boundaries(lower=sleep.lower, upper=sleep.upper)
        return self.resources.stream(durations(times, Fraction(self.resources.units), self.resources.options.mode, source))

    def publication(self, executor: str, handle: Handle, publication: Publication) -> int:
        """The record of a publication of a callback."""
        key = (executor, handle.name, publication.topic)
        if key not in self._publications:
            is_question = publication.waits and not publication.reliable
            timeout = layout.NEVER if publication.timeout is None else publication.timeout // publication.attempts
            fields = {
                layout.TIMEOUT_AFTER: self.resources.time(timeout),
                layout.ANSWERED_BY: self.messages.transmissions[publication.acknowledgement or ""] if is_question else 0,
            }
            self._publications[key] = self.resources.image.record(layout.PUBLICATION_SIZE, fields)
        return self._publications[key]

    def publications_of(self) -> dict[str, list[int]]:
        """The records of the publications of each executor."""
        records: dict[str, list[int]] = {name: [] for name in self.records}
        for (executor, _, _), record in self._publications.items():
            records[executor].append(record)
        return records

    def measure(self, executor: str, handle: Handle) -> int:
        """The record of the calls of a handle, from when it was asked for."""
        number = self.first_number + len(self.measured)
        self.measured.append((executor, handle.name))
        asked_at = self.messages.handles[executor, handle.name] + layout.RELEASED
        fields = {layout.EXECUTION_NUMBER: number, layout.ASKED_AT: asked_at}
        return self.resources.image.record(layout.EXECUTION_SIZE, fields)


def _pause(executor: Executor) -> Time:
    """The longest time between an iteration of an executor and the next one of its thread."""
    return executor.place.sleep if executor.place is not None else max(executor.loop.sleep, executor.loop.period or 0)


def _sleep_at(place: ThreadPlace) -> Interval[Time]:
    """The sleep after an iteration of one of several executors of a thread."""
    return Interval(place.sleep - place.sleep_early, place.sleep)


def _is_call(activity: Activity, runnable: str) -> bool:
    return isinstance(activity, Call) and activity.runnable == runnable


def _trigger_sets(executor: Executor) -> Sequence[frozenset[str]]:
    """The sets of handles of which one must be ready as a whole."""
    names = [handle.name for handle in executor.handles]
    match executor.trigger.kind:
        case TriggerKind.ANY:
            return [frozenset((name,)) for name in names]
        case TriggerKind.ALL:
            return [frozenset(names)]
        case TriggerKind.ALWAYS:
            return [frozenset()]
    return executor.trigger.sets


# Programs.


def add_activities(body: Body, process: Process) -> None:
    """Append the activities of a process, of the task of an executor those of an iteration.

    Raises
    ------
    UnknownError : something that its time depends on is not specified, or not simulated.
    """
    system = body.context.system
    executor = system.executor_of_task.get(process.name)
    if executor is not None:
        body.iteration = IterationCompiler(body, executor, body.resources.executors)
        body.iteration.add(process.activities)
        return
    for message in awaited(process.name, system, body.context.dataflow):
        raise UnknownError(
            f"it waits for the acknowledgement of {message.topic!r} outside an executor with a loop, which is not simulated"
        )
    if process.name in body.resources.executors.messages.transmissions:
        add_parts(body, process)
    else:
        body.activities(process.activities)


@dataclass(slots=True)
class IterationCompiler:
    """Makes the program of an iteration."""

    body: Body
    executor: Executor
    records: ExecutorRecords

    @property
    def record(self) -> int:
        """The record of the executor."""
        return self.records.records[self.executor.name]

    def add(self, activities: Sequence[Activity]) -> None:
        """The wait, the overhead, and the steps; then the next iteration is planned.

        Raises
        ------
        UnknownError : something that its time depends on is not stated.
        """
        self._check()
        body, code, steps = self.body, self.body.code, steps_of(self.executor)
        self.records.resources.context.notes.assume(_OVERHEAD)
        code.add(layout.LISTEN, self.record)
        if returns_at_once(self.executor):
            code.add(layout.BEGIN_WAIT, self.record)
        else:
            self._lock()
            code.add(layout.BEGIN_WAIT, self.record)
            self._read()
            self._unlock()
        code.add(layout.BEGIN_ITERATION, self.record)
        first = next((n + 1 for n, each in enumerate(activities) if _is_call(each, self.executor.spin)), 0)
        last = first + len(steps)
        code.add(layout.CHECK, self.record)
        body.activities(activities[:first])
        nothing = JumpLabel()
        code.add(layout.TEST_TRIGGER, self.record, nothing)
        for activity, step in zip(activities[first:last], steps, strict=True):
            assert isinstance(activity, ProbabilitySwitch)
            body.number += 1
            self._step(step, activity.branches[0].activities)
        code.mark(nothing)
        body.activities(activities[last:])
        code.add(layout.PLAN_ITERATION, self.record)

    def _check(self) -> None:
        for other in thread_of(self.executor, self.body.context.system.executors):
            if other.task not in self.body.resources.processes:
                raise UnknownError(f"{other.name!r}, which spins in the same loop, is not simulated")
        for handle in self.executor.handles:
            self._check_arrivals(handle)
            for publication in handle.publications:
                self._check_publication(publication)
        if self.executor.trigger.kind is TriggerKind.CUSTOM and not self.executor.trigger.sets:
            raise UnknownError("it is not specified when its trigger condition is true")

    def _check_arrivals(self, handle: Handle) -> None:
        """Refuse a handle of which it is unknown when it becomes ready: without its calls, others would be too early."""
        if handle.kind is HandleKind.LOOP_ITEM:
            return
        if handle.kind is HandleKind.TIMER:
            if handle.interval is None:
                raise UnknownError(f"the period of the timer {handle.name!r} is not specified")
        elif handle.transmission is None:
            if not handle.interval:
                raise UnknownError(f"it is not specified how often something arrives for {handle.name!r}")
        else:
            received = self.body.context.system.transmissions.get(handle.transmission)
            reason = f"{handle.transmission!r} is undefined" if received is None else self.records.messages.obstacle(received)
            if reason:
                raise UnknownError(f"it receives messages for {handle.name!r}: {reason}")

    def _check_publication(self, publication: Publication) -> None:
        """Refuse a publication of which it is unknown how long it waits for its acknowledgement."""
        if not publication.waits:
            return
        transmissions = self.body.context.system.transmissions
        sent, awaited = (transmissions.get(name or "") for name in (publication.transmission, publication.acknowledgement))
        is_known = sent is not None and awaited is not None and awaited.agent.simulated.most is not None
        if is_known and not any(self.records.messages.obstacle(each) for each in (sent, awaited) if each is not None):
            return
        until = "" if publication.timeout is None else f", up to {time_text(publication.timeout)}"
        raise UnknownError(
            f"it is not specified how long the publication of {publication.topic!r} waits for its acknowledgement{until}"
        )

    def _lock(self) -> None:
        if lock := self._session_lock():
            self.body.code.add(layout.REQUEST, lock, 0)

    def _unlock(self) -> None:
        if lock := self._session_lock():
            self.body.code.add(layout.UNLOCK, lock)

    def _session_lock(self) -> int:
        """The record of the lock of a session that several executors share; 0 if there is none."""
        is_shared = shares_session(self.executor, self.body.context.system.executors)
        return self.body.resources.semaphores[session_lock(self.executor)] if is_shared else 0

    def _read(self) -> None:
        """Read, and acknowledge what was read, until there is what it waits for."""
        code, done = self.body.code, JumpLabel()
        again = code.here()
        code.add(layout.READ, self.record, done)
        code.add(layout.REPLY, self.record, again)
        code.mark(done)

    def _step(self, step: IterationStep, activities: Sequence[Activity]) -> None:
        """A step, if its handle is ready."""
        code, record, skipped = self.body.code, self.records.messages.handles[self.executor.name, step.handle.name], JumpLabel()
        code.add(layout.TEST_DATA if step.takes else layout.TEST_READY, record, skipped)
        if step.takes:
            code.add(layout.TAKE_DATA, record)
        call = len(activities) - 1 if step.calls else len(activities)
        self.body.activities(activities[:call])
        if step.calls:
            calls = self.records.measure(self.executor.name, step.handle)
            code.add(layout.BEGIN_EXECUTION, calls)
            self.body.activities(activities[call:])
            code.add(layout.END_EXECUTION, calls)
        code.mark(skipped)

    def publish(self, transmission: str) -> None:
        """Write a message of the callback that is being called, and wait for its acknowledgements if the callback does."""
        published = next(self._publications(transmission), None)
        if published is None:
            self.body.code.add(layout.POST, self.records.messages.transmissions[transmission])
            return
        handle, publication = published
        code, record = self.body.code, self.records.publication(self.executor.name, handle, publication)
        self._lock()
        acknowledged_label = JumpLabel()
        for attempt in range(publication.attempts):
            if attempt:
                code.add(layout.TRY_AGAIN, record, acknowledged_label)
            code.add(layout.WRITE, self.records.messages.transmissions[transmission], record)
            if publication.waits:
                code.add(layout.EXPECT, self.record, record)
                self._read()
        code.mark(acknowledged_label)
        self._unlock()

    def _publications(self, transmission: str) -> Iterator[tuple[Handle, Publication]]:
        for handle in self.executor.handles:
            for publication in handle.publications:
                if publication.transmission == transmission and handle.runnable in self.body.above:
                    yield handle, publication


def _comes_without_wire(handle: Handle) -> bool:
    """Whether messages or triggers of a handle come over nothing that is described."""
    return handle.transmission is None and (is_message(handle) or handle.kind is HandleKind.GUARD_CONDITION)
