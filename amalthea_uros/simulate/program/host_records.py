"""The executors of the host in memory: threads, handles, and the lines of topics."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.host import HostCallback, HostExecutor, HostExecutorKind, RosRelease
from amalthea_uros.perf.network import Span, Transmission, plain_topic
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.simulate.arrivals import StimulusOccurrences, occurrences
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.program.host_system import runnable_name, sent_by_host, thread_names
from amalthea_uros.simulate.program.message_lines import Lines
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.timing.jobs.positions import ActivityPosition
from amalthea_uros.units import Time

#: Assumptions.
_ORDER = "where addresses in memory decide the order of a ready set, it is one at random for the whole run"
_REGISTERED = "where addresses in memory decide the order of a ready set, it is that of the description"
_THREADS = "host: only the described threads run on its computers, and deciding and taking messages take no time of their own"
_TOPICS = "host: latencies of topics are uniform between their limits, and keep the order of messages"
_RATES = "messages of the host that nothing described publishes come at the stated rate"


@dataclass(slots=True)
class HostRecords:
    """The records of the host; there are none if it is not simulated.

    Attributes
    ----------
    executors : by name
    threads : the records of threads, by task
    handles : by callback
    queues : what a message in the queue of a subscription was sent as, by callback
    arrivals : of messages that nothing described publishes
    """

    resources: Resources
    lines: Lines
    executors: dict[str, int] = field(default_factory=dict)
    threads: dict[str, int] = field(default_factory=dict)
    handles: dict[str, int] = field(default_factory=dict)
    queues: dict[str, int] = field(default_factory=dict)
    arrivals: list[tuple[int, StimulusOccurrences]] = field(default_factory=list)
    _stamps: dict[tuple[str, str, str], list[int]] = field(default_factory=dict)

    @property
    def is_simulated(self) -> bool:
        """Whether the threads of the host are simulated."""
        host, processes = self.resources.context.system.host, self.resources.processes
        names = [name for executor in host.executors for name in thread_names(executor)]
        return bool(names) and all(name in processes for name in names)

    def place(self) -> None:
        """Place the records of executors and of the messages that come to them from outside."""
        if not self.is_simulated:
            return
        self.resources.context.notes.assume(_THREADS)
        for executor in self.resources.context.system.host.executors:
            self._place(executor)
        for executor in self.resources.context.system.host.executors:
            for callback in executor.callbacks:
                self._bring(callback)

    def executor_of(self, thread: str) -> HostExecutor | None:
        """The executor of which a task stands for a thread."""
        if thread not in self.threads:
            return None
        return next(each for each in self.resources.context.system.host.executors if thread in thread_names(each))

    def threads_beside(self, process: str) -> tuple[str, ...]:
        """The threads of the executor of a thread, itself included; any other process is alone."""
        executor = self.executor_of(process)
        return (process,) if executor is None else thread_names(executor)

    def callback_at(self, position: ActivityPosition | None) -> HostCallback | None:
        """The callback of which an activity is the call by a thread."""
        activity = None if position is None else position.activity
        if not isinstance(activity, Call) or not self.is_simulated:
            return None
        host = self.resources.context.system.host
        return next((each for each in host.callbacks if runnable_name(each) == activity.runnable), None)

    # Executors.

    def _place(self, executor: HostExecutor) -> None:
        image, is_queue = self.resources.image, executor.kind is HostExecutorKind.EVENTS
        record = self.executors[executor.name] = image.record(layout.HOST_EXECUTOR_SIZE)
        inbox = image.record(layout.INBOX_SIZE, {layout.SLOTS: layout.NEVER})
        groups: dict[str, int] = {}
        for index, callback in enumerate(executor.callbacks):
            excludes = executor.kind is HostExecutorKind.MULTI_THREADED and not callback.is_reentrant
            if excludes and callback.group not in groups:
                groups[callback.group] = image.record(1)
            fields = {
                layout.HANDLE_OF: record,
                layout.HANDLE_INDEX: index,
                layout.ITS_GROUP: groups[callback.group] if excludes else 0,
            }
            self._place_handle(callback, fields, inbox)
        first, end = image.items(self.handles[each.name] for each in self._ready_order(executor))
        threads, threads_end = image.items([self._thread(name, record, inbox) for name in thread_names(executor)])
        release = self.resources.context.system.host.release
        fields = {
            layout.WORKS_BY: _working(executor, release),
            layout.READY_HANDLES: first,
            layout.READY_HANDLES_END: end,
            layout.ITS_THREADS: threads,
            layout.ITS_THREADS_END: threads_end,
            layout.KEEPS_TIMERS: int(not release.keeps_batches),
            # The first timer is never due before the beginning.
            layout.EXPIRES_WITH: self.lines.alarm(layout.HOST_TIMERS, record, at=0) if is_queue else 0,
        }
        image.put(record, fields)

    def _place_handle(self, callback: HostCallback, fields: dict[int, int], inbox: int) -> None:
        is_timer = callback.kind is HandleKind.TIMER
        fields |= {
            layout.HANDLE_KIND: layout.TIMER if is_timer else layout.RECEIVER,
            layout.DEPTH: callback.depth,
            layout.OVERWRITES: 1,
            layout.RELEASED: -1,
        }
        if callback.period is not None:
            fields[layout.TIMER_PERIOD] = self.resources.time(callback.period)
            fields[layout.NEXT_CALL] = self.resources.time(self._phase(callback.name, callback.period, first=callback.period))
        handle = self.handles[callback.name] = self.resources.image.record(layout.HANDLE_SIZE, fields)
        sent = {layout.READ_FROM: inbox, layout.FOR_HANDLE: handle, layout.PARTS_OF: 1}
        self.queues[callback.name] = self.resources.image.record(layout.TRANSMISSION_SIZE, sent)

    def _phase(self, name: str, interval: Time, first: Time) -> Time:
        """The first time of something with an interval: at random, `first` if nothing is random."""
        self.resources.assume_phase()
        is_random = self.resources.options.mode is SimulationMode.SAMPLED
        return self.resources.random_phase(f"host {name}") * interval >> 64 if is_random else first

    def _thread(self, name: str, executor: int, inbox: int) -> int:
        """The record of a thread; it begins at 0."""
        image, resources = self.resources.image, self.resources
        record = self.threads[name] = image.record(layout.EXECUTOR_SIZE)
        fields = {
            layout.READER_PROCESS: resources.processes[name],
            layout.INBOX: inbox,
            layout.WAIT_ALARM: self.lines.alarm(layout.END_OF_WAIT, record),
            layout.LOOP_STIMULUS: resources.stimuli[name],
            layout.LOOP_ALARM: self.lines.alarm(layout.NEXT_ITERATION, record, at=0),
            layout.NEXT_PROCESS: resources.processes[name],
            layout.THREAD_OF: executor,
        }
        image.put(record, fields)
        return record

    def _ready_order(self, executor: HostExecutor) -> Sequence[HostCallback]:
        """The callbacks in the order of a ready set: by kind, then as the distribution orders them."""
        release = self.resources.context.system.host.release
        mixed = list(executor.callbacks)
        in_groups: dict[str, list[HostCallback]] = {}
        for callback in mixed:
            key = callback.group if release.keeps_batches else callback.name
            in_groups.setdefault(key, []).append(callback)
        # Up to foxy, groups are in the order of registration; from jazzy on, each handle has a place by its address.
        if release is not RosRelease.FOXY and len(in_groups) > 1:
            is_random = self.resources.options.mode is SimulationMode.SAMPLED
            self.resources.context.notes.assume(_ORDER if is_random else _REGISTERED)
            keys = sorted(in_groups, key=self._address) if is_random else list(in_groups)
            mixed = [callback for key in keys for callback in in_groups[key]]
        return sorted(mixed, key=lambda each: executor.rank(each, release))

    def _address(self, name: str) -> int:
        return self.resources.random_phase(f"address {name}")

    # Topics.

    def receiving_lines(self, transmission: Transmission) -> list[int]:
        """The lines from the agent to the subscriptions of a message of a controller."""
        if not self.is_simulated:
            return []
        topic = plain_topic(transmission.topic)
        return [self._line(each, topic) for each in self._subscribing(topic)]

    def publications(self, callback: HostCallback, thread: str, transmissions: dict[str, int]) -> Iterator[int]:
        """The records of what a callback publishes at its end in a thread, for each subscription and each message to a controller."""
        for topic in callback.publishes:
            for each in self._subscribing(topic):
                yield self._publication((callback.name, thread, each.name), self._line(each, topic))
            for sent in sent_by_host(self.resources.context.system, topic):
                delay = self.lines.delay(f"from host {sent.name}", self._latency(topic), sent.agent)
                line = self.lines.line_of(transmissions[sent.name], delay, layout.TO_WIRE)
                yield self._publication((callback.name, thread, sent.name), line)

    def carry(self, callback: HostCallback, target: str, places: Mapping[str, int], index: int) -> None:
        """Have what a callback publishes to a subscription, or as a message to a controller, carry a value.

        Parameters
        ----------
        places : of the value in memory, by thread
        """
        for thread, place in places.items():
            self._stamps.setdefault((callback.name, thread, target), []).extend((place, index))

    def _publication(self, carried: tuple[str, str, str], line: int) -> int:
        first, end = self.resources.image.items(self._stamps.get(carried, ()))
        fields = {layout.PUBLISHES_ON: line, layout.PUBLISHED_STAMPS: first, layout.PUBLISHED_STAMPS_END: end}
        return self.resources.image.record(layout.HOST_PUBLICATION_SIZE, fields)

    def is_sent_by_host(self, transmission: Transmission) -> bool:
        """Whether callbacks of the simulated host send a message."""
        return self.is_simulated and any(
            plain_topic(transmission.topic) in each.publishes for each in self.resources.context.system.host.callbacks
        )

    def _subscribing(self, topic: str) -> list[HostCallback]:
        return [each for each in self.resources.context.system.host.callbacks if each.topic == topic]

    def _latency(self, topic: str) -> Span:
        return next(each.latency for each in self.resources.context.system.host.topics if each.name == topic)

    def _line(self, callback: HostCallback, topic: str) -> int:
        latency = self._latency(topic)
        if latency.most != latency.least:
            self.resources.context.notes.assume(_TOPICS)
        delay = self.lines.delay(f"topic {topic} to {callback.name}", latency)
        return self.lines.line_of(self.queues[callback.name], delay, layout.TO_HOST_QUEUE)

    def _bring(self, callback: HostCallback) -> None:
        """Have messages arrive that nothing described publishes."""
        system, options = self.resources.context.system, self.resources.options
        topic = next((each for each in system.host.topics if each.name == callback.topic and each.interval), None)
        if topic is None or topic.interval is None:
            return
        self.resources.context.notes.assume(_RATES)
        jitter = Uniform(lower=0, upper=topic.jitter) if topic.jitter else None
        offset = self._phase(f"topic {topic.name}", topic.interval, first=0)
        stimulus = Periodic(name=f"messages of {topic.name}", period=topic.interval, offset=offset, jitter=jitter)
        line = self.lines.line_of(self.queues[callback.name], self.lines.delay("", Span(most=0)), layout.TO_HOST_QUEUE)
        record = self.resources.image.record(layout.STIMULUS_SIZE, {layout.BRINGS: line})
        source = RandomSource(options.seed, f"stimulus {stimulus.name}")
        self.arrivals.append((record, occurrences(stimulus, system, options.mode, source, self.resources.units)))


def _working(executor: HostExecutor, release: RosRelease) -> int:
    """How an executor works: static ones of jazzy call one callback for each wait."""
    if executor.kind is HostExecutorKind.EVENTS:
        return layout.EVENT_QUEUE
    is_first = executor.kind is HostExecutorKind.STATIC and not release.keeps_batches
    return layout.FIRST_READY if is_first else layout.READY_SET
