"""Reliable messages in memory: the flows of sessions, who asks for missing acknowledgements, and what is lost on wires."""

from __future__ import annotations

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.executors.semantics.callbacks import taker
from amalthea_uros.executors.semantics.losses import is_question, losses_text, parts
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.network import BILLION, Direction, Losses, Purpose, Transmission, Wire
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.kernel.losses import MOST_PASSING
from amalthea_uros.simulate.kernel.message_records import MOST_PARTS
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.program.entities import losses_name
from amalthea_uros.simulate.program.messages import MessageRecords
from amalthea_uros.simulate.sampling.streams import ValueStream, choices, constant, values
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.trace.table import EntityKind

#: Of times, so that the values of a stream fit into 62 bits.
_LONGEST = 2**58
_NONE_IN_BEST = "no message is lost on {!r} in the mode best, whatever losses are stated"
_AGAIN = "the agent takes as long to send a message again as to send it for the first time"


@dataclass(slots=True)
class FlowRecords:
    """The records of flows and of losses.

    Attributes
    ----------
    flows : by the record of the inbox of a session, and direction
    """

    messages: MessageRecords
    flows: dict[tuple[int, Direction], int] = field(default_factory=dict)

    def place(self) -> None:
        """Place and fill the records."""
        for wire in self.messages.system.network.wires:
            lossy = {direction: self._losses(wire, direction) for direction in Direction}
            for each in self._on(wire):
                if lossy[each.direction]:
                    first, end = self.messages.image.items(lossy[each.direction])
                    self.messages.image.put(
                        self.messages.transmissions[each.name], {layout.LOSES: first, layout.LOSES_END: end}
                    )
                if each.purpose is Purpose.DATA:
                    self._place_in_flow(each, wire)

    def out_of(self, executor: str) -> int:
        """The flow of what an executor sends; 0 if it sends nothing reliable."""
        return self.flows.get((self.messages.inboxes[executor], Direction.TO_AGENT), 0)

    def on_lossy_wires(self) -> dict[str, int]:
        """The records of messages on wires of which it is stated how many they lose."""
        lossy = [each.name for wire in self.messages.system.network.wires if wire.losses for each in self._on(wire)]
        return {name: self.messages.transmissions[name] for name in lossy}

    def _on(self, wire: Wire) -> list[Transmission]:
        every = (self.messages.system.transmissions[name] for name in self.messages.transmissions)
        return [each for each in every if each.wire == wire.name]

    # Flows.

    def _place_in_flow(self, transmission: Transmission, wire: Wire) -> None:
        """If a message is acknowledged, and it is known who does or awaits it: the flow to which it belongs."""
        messages, system = self.messages, self.messages.system
        reply = next((each for each in system.transmissions.values() if each.acknowledges == transmission.name), None)
        is_received = transmission.direction is Direction.TO_CONTROLLER
        ready = taker(transmission, system)
        executor = messages.sender(transmission) if not is_received else None if ready is None else ready[0]
        if reply is None or executor is None or reply.name not in messages.transmissions or is_question(transmission, system):
            return
        record = messages.transmissions[transmission.name]
        fields = {
            layout.FLOW: self._flow(messages.inboxes[executor.name], transmission.direction, wire),
            layout.PARTS_OF: parts(reply, system),
        }
        if wire.losses:
            messages.sent_again.add(transmission.name)
        if wire.losses and is_received:
            messages.resources.context.notes.assume(_AGAIN)
            # All of a flow wait in one queue of the agent.
            line = messages.image.words[fields[layout.FLOW] + layout.SENT_AGAIN_ON] or messages.line(
                transmission, messages.lines.delay(f"again {transmission.name}", transmission.agent), layout.TO_WIRE
            )
            messages.image.put(fields[layout.FLOW], {layout.SENT_AGAIN_ON: line})
        messages.image.put(record, fields)

    def _flow(self, inbox: int, direction: Direction, wire: Wire) -> int:
        if (inbox, direction) not in self.flows:
            self.flows[inbox, direction] = self._new_flow(inbox, direction, wire)
        return self.flows[inbox, direction]

    def _new_flow(self, inbox: int, direction: Direction, wire: Wire) -> int:
        """A flow; without losses there is room for everything, as nobody has to wait for what is missing."""
        messages, recovery, time = self.messages, wire.recovery, self.messages.resources.time
        fields = {layout.FLOW_INBOX: inbox, layout.ASKS_AT: layout.NEVER, layout.SEND_ROOM: layout.NEVER}
        fields[layout.RECEIVE_ROOM] = MOST_PARTS
        is_received = direction is Direction.TO_CONTROLLER
        if recovery is not None and wire.losses:
            room = recovery.agent_sent_parts if is_received else recovery.sent_parts
            fields[layout.SEND_ROOM] = min(room or MOST_PARTS, MOST_PARTS)
            if is_received:
                fields[layout.RECEIVE_ROOM] = min(recovery.received_parts or MOST_PARTS, MOST_PARTS)
        asks_as = next(
            (each for each in self._on(wire) if each.purpose is Purpose.HEARTBEAT and each.direction is direction), None
        )
        if recovery is not None and asks_as is not None:
            fields[layout.ASKS_AS] = messages.transmissions[asks_as.name]
            fields[layout.ASKS_AFTER] = time(recovery.agent_asks_every if is_received else recovery.asks_after)
        flow = messages.image.record(layout.FLOW_SIZE, fields)
        if is_received and recovery is not None and asks_as is not None:
            messages.lines.alarm(layout.AGENT_ASKS, flow, at=self._first_look(wire, recovery.agent_asks_every))
        return flow

    def _first_look(self, wire: Wire, interval: int) -> int:
        """When the agent looks for the first time whether something is not acknowledged."""
        resources = self.messages.resources
        if resources.options.mode is not SimulationMode.SAMPLED:
            return resources.time(interval)
        resources.assume_phase()
        return resources.time(resources.random_phase(f"agent of {wire.name}") * interval >> 64)

    # Losses.

    def _losses(self, wire: Wire, direction: Direction) -> list[int]:
        """The records of what loses messages in a direction; one record for both if they are counted together."""
        if self.messages.resources.options.mode is SimulationMode.BEST:
            if wire.losses:
                self.messages.resources.context.notes.assume(_NONE_IN_BEST.format(wire.name))
            return []
        records = self.messages.losses
        here = [losses for losses in wire.losses if direction in losses.directions]
        for losses in here:
            if (wire.name, losses) not in records:
                records[wire.name, losses] = self._new_losses(wire, losses)
        return [records[wire.name, losses] for losses in here]

    def _new_losses(self, wire: Wire, losses: Losses) -> int:
        resources = self.messages.resources
        resources.context.notes.assume(losses_text(wire, losses))
        stream = self._values(wire, losses)
        first = int(stream.take(1)[0]) if losses.window else 0
        times, _ = resources.image.items([-layout.NEVER] * losses.count)
        fields = {
            layout.LOSS_VALUES: resources.stream(stream),
            layout.LOSS_COUNT: losses.count,
            layout.LOSS_WINDOW: resources.time(losses.window),
            layout.LOSS_TIMES: times,
            layout.NEXT_LOSS: first // MOST_PASSING,
            layout.PASSING: first % MOST_PASSING,
            layout.LOSS_ENTITY: resources.entities.number(EntityKind.STIMULUS, losses_name(wire)),
        }
        return resources.image.record(layout.LOSSES_SIZE, fields)

    def _values(self, wire: Wire, losses: Losses) -> ValueStream:
        """The values that decide: whether each message is lost, or the times after which the next one can be."""
        resources = self.messages.resources
        directions = " and ".join(losses.directions)
        source = RandomSource(resources.options.seed, f"losses on {wire.name} {directions}")
        if not losses.window:
            return choices([BILLION - losses.per_billion, losses.per_billion], SimulationMode.SAMPLED, source)
        if resources.options.mode is SimulationMode.WORST:
            return constant(0)
        # The time, and how many messages get through then before one is lost.
        longest = min(2 * resources.time(losses.window) // losses.count, _LONGEST)
        return values(Uniform(lower=0, upper=MOST_PASSING * longest), resources.options.mode, source)
