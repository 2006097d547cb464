"""Messages in memory: on wires and on the delay lines between these, the agent and the controller, and where they wait to be read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.executors.semantics.callbacks import taker
from amalthea_uros.executors.semantics.losses import parts
from amalthea_uros.perf.activities import Trigger, walk
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.executors import Executor, Handle, HandleKind
from amalthea_uros.perf.host import HostCallback
from amalthea_uros.perf.network import Direction, Losses, Purpose, Span, Transmission
from amalthea_uros.perf.stimuli import InterProcess, Periodic, Stimulus
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.arrivals import StimulusOccurrences, occurrences
from amalthea_uros.simulate.arrivals.periodic import NO_LONGER
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.program.host_records import HostRecords
from amalthea_uros.simulate.program.host_system import why_not_simulated
from amalthea_uros.simulate.program.image import Image, Operation
from amalthea_uros.simulate.program.message_lines import Lines
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.timing.activation.relays import latency_between, relayed
from amalthea_uros.units import Time

#: Assumptions.
_HOST = "the host is not simulated: its messages come at the interval and with the jitter that the controller states"
_AT_ONCE = Span(most=0)
#: The kinds of handles that receive no messages.
_KINDS = {HandleKind.TIMER: layout.TIMER, HandleKind.GUARD_CONDITION: layout.FLAG, HandleKind.LOOP_ITEM: layout.ITEM}


@dataclass(slots=True)
class MessageRecords:
    """The records of what messages pass.

    Attributes
    ----------
    transmissions : by name, those that are followed: not foreign frames
    inboxes : where messages wait to be read, by executor; those of a session have one together
    handles : by executor and handle
    sent : the transmission that a stimulus stands for, if something here sends it
    brought : by stimulus, the line on which each occurrence brings a message, and what occurs
    arrivals : of messages that come over no wire
    from_host : the stimuli of messages that the simulated host sends
    lines : what delays messages, and alarms
    host : the executors of the host
    acknowledging_lines : by the name of the message with which the agent acknowledges
    lines_in : the lines from the end of each wire, by the wire and what they lead to
    sent_again : reliable messages on wires of which it is stated how many they lose
    losses : the records of what loses messages, by wire
    """

    resources: Resources
    transmissions: dict[str, int] = field(default_factory=dict)
    inboxes: dict[str, int] = field(default_factory=dict)
    handles: dict[tuple[str, str], int] = field(default_factory=dict)
    sent: dict[str, Transmission] = field(default_factory=dict)
    brought: dict[str, tuple[int, Stimulus]] = field(default_factory=dict)
    arrivals: list[tuple[int, StimulusOccurrences]] = field(default_factory=list)
    lines: Lines = field(init=False)
    host: HostRecords = field(init=False)
    from_host: set[str] = field(default_factory=set)
    acknowledging_lines: dict[str, int] = field(default_factory=dict)
    lines_in: dict[tuple[str, int], int] = field(default_factory=dict)
    sent_again: set[str] = field(default_factory=set)
    losses: dict[tuple[str, Losses], int] = field(default_factory=dict)
    _receivers: dict[str, bool] | None = None
    _carried: int = 0
    _stamps: dict[tuple[int, int], list[int]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.lines = Lines(self.resources)
        self.host = HostRecords(self.resources, self.lines)

    @property
    def system(self) -> System:
        """The system."""
        return self.resources.context.system

    @property
    def image(self) -> Image:
        """The memory."""
        return self.resources.image

    # Places.

    def place(self) -> None:
        """Place the records; they are filled when all have a place."""
        self.host.place()
        for client in self.system.clients:
            self._place_executors(client.executors)
        for transmission in self.system.transmissions.values():
            is_followed = transmission.purpose is not Purpose.FOREIGN and transmission.name in self.resources.processes
            if is_followed and self.system.processes[transmission.name].stimuli:
                self.transmissions[transmission.name] = self.image.record(layout.TRANSMISSION_SIZE)
                self._assume(transmission)
        for name in self.transmissions:
            self._fill(self.system.transmissions[name])

    def _place_executors(self, executors: Iterable[Executor]) -> None:
        """Place the buffers and the handles of the executors of a client."""
        sessions: dict[str | None, int] = {}
        for executor in executors:
            slots = executor.waiting.slots
            inbox = self.image.record(layout.INBOX_SIZE, {layout.SLOTS: layout.NEVER if slots is None else slots})
            # Who receives nothing reads while a publication of it waits, whatever comes.
            self.inboxes[executor.name] = sessions.setdefault(executor.session, inbox)
            for handle in executor.handles:
                self.handles[executor.name, handle.name] = self._handle(executor, handle)

    def _assume(self, transmission: Transmission) -> None:
        """Say what is assumed of a message beyond what is stated."""
        assume = self.resources.context.notes.assume
        if transmission.is_dropped_when_busy or any(
            wire.name == transmission.wire and wire.loses_messages and not wire.losses for wire in self.system.network.wires
        ):
            assume(f"no message is lost on {transmission.wire!r}, or dropped because another thread is sending")
        if relayed(transmission, self.system):
            assume(f"messages of {transmission.topic!r} come only from the publishers that are described")
        if self.system.host.executors and not self.host.is_simulated:
            assume(f"{_HOST}: {why}" if (why := why_not_simulated(self.system)) else _HOST)

    def _handle(self, executor: Executor, handle: Handle) -> int:
        kind = _KINDS.get(handle.kind, layout.RECEIVER)
        fields = {
            layout.HANDLE_KIND: kind,
            layout.DEPTH: layout.NEVER if handle.depth is None else handle.depth,
            layout.OVERWRITES: int(handle.overwrites),
            layout.IS_ALWAYS_CALLED: int(handle.always),
            layout.RELEASED: -1,
        }
        if kind == layout.ITEM:
            fields[layout.TIMER_PERIOD] = self.resources.time(handle.interval or 0)
        if kind == layout.TIMER and handle.interval is not None:
            fields[layout.TIMER_PERIOD] = self.resources.time(handle.interval)
            fields[layout.NEXT_CALL] = self.resources.time(self._phase(handle, handle.interval, first=handle.interval))
        return self.image.record(layout.HANDLE_SIZE, fields)

    def _phase(self, handle: Handle, interval: Time, first: Time) -> Time:
        """The first time of something with an interval: as stated, or at random; `first` if nothing is random."""
        if handle.phase is not None:
            return handle.phase
        self.resources.assume_phase()
        is_random = self.resources.options.mode is SimulationMode.SAMPLED
        return self.resources.random_phase(f"handle {handle.name}") * interval >> 64 if is_random else first

    # Transmissions.

    def _fill(self, transmission: Transmission) -> None:
        system, stimulus = self.system, self.system.processes[transmission.name].stimuli[0]
        record = self.transmissions[transmission.name]
        fields = {layout.WIRE_STIMULUS: self.resources.stimuli[stimulus]}
        if transmission.direction is Direction.TO_CONTROLLER:
            fields |= self._receiving(transmission)
        else:
            wire = next(each for each in system.network.wires if each.name == transmission.wire)
            fields[layout.HOLDS_WRITER] = int(wire.keeps_sender)
            if transmission.purpose is Purpose.ACKNOWLEDGEMENT:
                arrives = self.lines.delay(f"to agent {transmission.name}", transmission.link)
                fields |= self._line_in(transmission, arrives, layout.TO_AGENT_ITSELF)
            if transmission.purpose is Purpose.DATA:
                fields[layout.TO_HOST] = self.lines.delay(f"to host {transmission.name}", transmission.link, transmission.agent)
        self.image.put(record, fields)
        if isinstance(system.stimuli_by_name[stimulus], InterProcess):
            self.sent[stimulus] = transmission
        elif self.host.is_sent_by_host(transmission):
            self.from_host.add(stimulus)
        else:
            self._bring(transmission, system.stimuli_by_name[stimulus])
        self._acknowledge(transmission)
        lines = [
            self.line(relay, self.lines.delay(f"relay {relay.name}", *self._on_its_way(transmission, relay)), layout.TO_WIRE)
            for relay in self._relays(transmission)
        ]
        first, end = self.image.items([*lines, *self.host.receiving_lines(transmission)])
        self.image.put(record, {layout.RELAYS: first, layout.RELAYS_END: end})

    def _relays(self, transmission: Transmission) -> list[Transmission]:
        """The messages as which the agent sends a message back."""
        every = (self.system.transmissions[name] for name in self.transmissions)
        return [each for each in every if transmission in relayed(each, self.system)]

    def _on_its_way(self, sent: Transmission, relay: Transmission) -> Iterator[Span]:
        """The times of a message from the agent until it is queued on the wire to its receiver."""
        between = latency_between(sent, relay, self.system)
        if between != Span(most=0):
            yield between
        yield relay.agent

    def _receiving(self, transmission: Transmission) -> dict[int, int]:
        """The fields of a transmission that the controller receives."""
        system = self.system
        arrives = self.lines.delay(f"receive {transmission.name}", transmission.link, transmission.driver)
        fields = self._line_in(transmission, arrives, layout.TO_RECEIVER)
        received_by = self.receiving_stimulus(transmission)
        if received_by is not None:
            fields[layout.RECEIVED_BY] = self.resources.stimuli[received_by]
        ready = taker(transmission, system)
        reader = ready[0] if ready is not None else self._reader_of(transmission)
        if reader is not None and reader.task in self.resources.processes:
            fields[layout.READ_FROM] = self.inboxes[reader.name]
        if ready is not None:
            fields[layout.FOR_HANDLE] = self.handles[ready[0].name, ready[1].name]
        reply = next((each for each in system.transmissions.values() if each.acknowledges == transmission.name), None)
        if (
            reply is not None
            and reply.direction is Direction.TO_AGENT
            and reply.name in self.transmissions
            and reader is not None
        ):
            fields |= {layout.REPLY_WITH: self.transmissions[reply.name], layout.REPLIES: parts(reply, system)}
        return fields

    def _reader_of(self, transmission: Transmission) -> Executor | None:
        """The executor that reads what no handle takes: an acknowledgement is read by whoever waits for it."""
        acknowledged = self.system.transmissions.get(transmission.acknowledges or "")
        sender = None if acknowledged is None else self.sender(acknowledged)
        return sender or next(iter(self.system.client_at(transmission.wire).executors), None)

    def sender(self, transmission: Transmission) -> Executor | None:
        """The executor that sends a message; None if none does that loops."""
        for executor in self.system.executors:
            if any(transmission.name == each.transmission for handle in executor.handles for each in handle.publications):
                return executor
        return None

    def receiving_stimulus(self, transmission: Transmission) -> str | None:
        """The stimulus of the first process that a message passes: that which the end of its last frame triggers; None for none."""
        if transmission.direction is not Direction.TO_CONTROLLER:
            return None
        activated = {name for process in self.resources.processes for name in self.system.processes[process].stimuli}
        fired = [
            each.stimulus for each in walk(self.system.processes[transmission.name].activities) if isinstance(each, Trigger)
        ]
        return fired[-1] if fired and fired[-1] in activated and fired[-1] not in self.sent else None

    @property
    def receivers(self) -> Mapping[str, bool]:
        """The processes that messages pass in the controller, and whether each is the last one."""
        if self._receivers is None:
            self._receivers = {}
            for name in self.transmissions:
                for process, is_last in self._passed(self.system.transmissions[name]):
                    self._receivers[process] = is_last
        return self._receivers

    def _passed(self, transmission: Transmission) -> Iterator[tuple[str, bool]]:
        stimulus = self.receiving_stimulus(transmission)
        if stimulus is None:
            return
        first = next(name for name in self.resources.processes if stimulus in self.system.processes[name].stimuli)
        passed = transmission.processes if first in transmission.processes[:1] else (first,)
        yield from ((process, process == passed[-1]) for process in passed)

    def obstacle(self, transmission: Transmission) -> str:
        """Why it is not known when a message gets to the executor, or from there to the host; "" if it is."""
        name, is_received = transmission.name, transmission.direction is Direction.TO_CONTROLLER
        if name not in self.transmissions:
            is_simulated = name in self.resources.processes
            return f"it is not specified when {name!r} is sent" if is_simulated else f"{name!r} is not simulated"
        if left_out := [each for each in transmission.processes if each not in self.resources.processes]:
            return f"{left_out[0]!r}, which {name!r} passes, is not simulated"
        if None in (transmission.link.most, transmission.driver.most if is_received else 0):
            return f"it is not specified how long {name!r} takes besides the wire"
        for sent in relayed(transmission, self.system):
            if None in (sent.agent.simulated.most, *(each.simulated.most for each in self._on_its_way(sent, transmission))):
                return f"it is not specified how long messages of {transmission.topic!r} take from {sent.callback!r}"
        return ""

    def _acknowledge(self, transmission: Transmission) -> None:
        """If a message acknowledges one of the controller: the line on which the agent puts it."""
        if transmission.acknowledges is None or transmission.direction is not Direction.TO_CONTROLLER:
            return
        sent = self.system.transmissions.get(transmission.acknowledges)
        if sent is not None:
            delay = self.lines.delay(f"acknowledge {transmission.name}", sent.link, transmission.agent)
            self.acknowledging_lines[transmission.name] = self.line(transmission, delay, layout.TO_WIRE)

    def _bring(self, transmission: Transmission, stimulus: Stimulus) -> None:
        """Have each occurrence of a stimulus bring a message."""
        ready = taker(transmission, self.system)
        if transmission.purpose is Purpose.DATA and transmission.direction is Direction.TO_CONTROLLER and ready is not None:
            stimulus = self._published(stimulus.name, ready[1]) or stimulus
            line = self.line(
                transmission, self.lines.delay(f"from host {transmission.name}", transmission.agent), layout.TO_WIRE
            )
        else:
            line = self.line(transmission, self.lines.delay("", _AT_ONCE), layout.TO_WIRE)
        self.brought[stimulus.name] = (line, stimulus)

    def _published(self, name: str, handle: Handle, others: Sequence[Handle] = ()) -> Stimulus | None:
        """When the host publishes what a handle receives; None if that is not known.

        Parameters
        ----------
        others : handles of the same callback, which receive in turn, itself included
        """
        if not handle.interval:
            return None
        if not handle.is_periodic:
            self.resources.context.notes.assume(NO_LONGER)
        turns = list(others) or [handle]
        jitter = Uniform(lower=0, upper=handle.jitter) if handle.jitter else None
        offset = self._phase(turns[0], handle.interval, first=0) + turns.index(handle) * handle.interval
        return Periodic(name=name, period=len(turns) * handle.interval, offset=offset, jitter=jitter)

    def bring_without_wire(self, executor: Executor, handle: Handle) -> None:
        """Have messages of a handle arrive that come over no wire that is described."""
        # The rate is that of the requests of all services of a callback.
        alike = [each for each in executor.handles if each.runnable == handle.runnable]
        stimulus = self._published(f"messages for {handle.name}", handle, alike)
        assert stimulus is not None
        fields = {layout.READ_FROM: self.inboxes[executor.name], layout.FOR_HANDLE: self.handles[executor.name, handle.name]}
        transmission = self.image.record(layout.TRANSMISSION_SIZE, fields)
        line = self.lines.line_of(transmission, self.lines.delay("", _AT_ONCE), layout.TO_RECEIVER)
        record = self.image.record(layout.STIMULUS_SIZE, {layout.BRINGS: line})
        source = RandomSource(self.resources.options.seed, f"stimulus {stimulus.name}")
        times = occurrences(stimulus, self.system, self.resources.options.mode, source, self.resources.units)
        self.arrivals.append((record, times))

    # Lines.

    def _line_in(self, transmission: Transmission, delay: int, leads_to: int) -> dict[int, int]:
        """The fields of a transmission that say how its messages come from the wire: on the line that all of the wire share."""
        if (transmission.wire, leads_to) not in self.lines_in:
            self.lines_in[transmission.wire, leads_to] = self.lines.line_of(0, 0, leads_to)
        return {layout.LINE_IN: self.lines_in[transmission.wire, leads_to], layout.DELAY_IN: delay}

    def line(self, transmission: Transmission, delay: int, leads_to: int) -> int:
        """A line of messages with a stream of delays."""
        return self.lines.line_of(self.transmissions[transmission.name], delay, leads_to)

    # What messages carry, and what processes do with them.

    def carry(self, transmission: Transmission, source: int, target: Transmission | tuple[str, str], place: int) -> None:
        """Have a message carry a value from a place in memory to another one.

        Parameters
        ----------
        target : the message as which the agent sends it back, or the executor and the handle that take it
        """
        index, self._carried = self._carried, self._carried + 1
        self._stamp(self.transmissions[transmission.name], layout.STAMPS_FROM, source, index)
        if isinstance(target, Transmission):
            self._stamp(self.transmissions[target.name], layout.STAMPS_TO, place, index)
        else:
            self._stamp(self.handles[target], layout.HANDLE_STAMPS, place, index)

    def carry_on_host(
        self, source: Transmission | HostCallback, target: Transmission | HostCallback, stages: Mapping[str, int], place: int
    ) -> None:
        """Have a message of the host, or to it, carry the value of a stage of a chain to a place in memory.

        Parameters
        ----------
        stages : the records of the stage, by process
        """
        places = {process: stage + layout.LINK for process, stage in stages.items()}
        index, self._carried = self._carried, self._carried + 1
        if isinstance(source, Transmission):
            self._stamp(self.transmissions[source.name], layout.STAMPS_FROM, places[source.name], index)
        else:
            self.host.carry(source, target.name, places, index)
        if isinstance(target, Transmission):
            self._stamp(self.transmissions[target.name], layout.STAMPS_TO, place, index)
        else:
            self._stamp(self.host.handles[target.name], layout.HANDLE_STAMPS, place, index)

    def keep(self, name: str, stage: int) -> None:
        """Have a message that can be sent again keep the value of a stage of a chain that it has on the wire."""
        self._stamp(self.transmissions[name], layout.KEEPS, stage, self._carried)
        self._carried += 1

    def respond(self, name: str, stage: int) -> None:
        """Have a message that can wait for earlier ones be the response of a chain when the host gets it."""
        record, index = self.transmissions[name], self._carried
        self._carried += 1
        self._stamp(record, layout.STAMPS_FROM, stage + layout.LINK, index)
        self._stamp(record, layout.RESPONSES, stage, index)

    def _stamp(self, record: int, first: int, place: int, index: int) -> None:
        self._stamps.setdefault((record, first), []).extend((place, index))

    def is_about_message(self, process: str) -> bool:
        """Whether the jobs of a process are about a message each."""
        return process in self.transmissions or process in self.receivers

    def last_operations(self, process: str) -> Sequence[Operation]:
        """The operations of a process on its message at the very end of a job."""
        if process in self.transmissions:
            return [(layout.PASS_ON, self.transmissions[process], 0)]
        return [(layout.HAVE_READ, 0, 0)] if self.receivers.get(process) else []

    def first_operations_of_end(self, process: str) -> Sequence[Operation]:
        """The operations of a process on its message at the end of a job, before those of chains."""
        record = self.transmissions.get(process, 0)
        is_later = process in self.sent_again
        return [(layout.DEPART, record, 0)] if record and self.image.words[record + layout.TO_HOST] and not is_later else []

    def head(self) -> dict[int, int]:
        """The head of the memory; fills the lists of what is carried."""
        for (record, field_), pairs in self._stamps.items():
            first, end = self.image.items(pairs)
            self.image.put(record, {field_: first, field_ + 1: end})
        first, end = self.image.items(self.lines.alarms)
        return {layout.CARRIED_VALUES: self._carried, layout.ALARMS: first, layout.ALARMS_END: end}
