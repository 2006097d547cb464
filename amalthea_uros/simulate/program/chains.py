"""The routes of event chains: their stages as records, and what they add to the programs of the processes that they pass."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.semantics.callbacks import taker
from amalthea_uros.perf.activities import Communication, Trigger
from amalthea_uros.perf.events import EventChain
from amalthea_uros.perf.host import HostCallback
from amalthea_uros.perf.network import Direction, Purpose, Transmission
from amalthea_uros.perf.software import Process
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.program.image import Operation, ProgramHooks
from amalthea_uros.simulate.program.message_routes import MessageRoutes
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.timing.dataflow.chains import unfold
from amalthea_uros.timing.dataflow.events import JobPhase
from amalthea_uros.timing.dataflow.links import LinkKind
from amalthea_uros.timing.dataflow.routes import Route, crosses, route_text, routes_of_paths
from amalthea_uros.timing.dataflow.stages import At, Fire, Pass, Read, Stage, Write, stages
from amalthea_uros.timing.jobs.positions import ActivityPosition
from amalthea_uros.trace.table import EntityKind

#: Links whose effect is not followed, because the model does not say when it takes place.
_NOT_FOLLOWED = (LinkKind.OS_EVENT, LinkKind.SERVER_CALL, LinkKind.MESSAGE)

#: When a response at no activity of a job occurs: where the record of the process has the time; 0: now.
_RESPONSE_TIMES = {JobPhase.ACTIVATION: layout.ACTIVATION, JobPhase.START: layout.START, JobPhase.END: 0}


@dataclass(frozen=True, slots=True)
class FollowedRoute:
    """A path through a chain that is followed; its number is that in observations.

    Attributes
    ----------
    text : the events of the path; with the links between them if these are not the only ones
    """

    chain: str
    text: str


@dataclass(slots=True)
class ChainCompiler:
    """Makes the chains of a system something that the kernel follows.

    Attributes
    ----------
    hooks : by process
    captures : by process: the places of the words that each activation keeps
    let_stages : by process: the stages that write at the end of the period
    left_out : why a chain is not followed
    """

    resources: Resources
    hooks: dict[str, ProgramHooks] = field(default_factory=dict)
    captures: dict[str, list[int]] = field(default_factory=dict)
    let_stages: dict[str, list[int]] = field(default_factory=dict)
    routes: list[FollowedRoute] = field(default_factory=list)
    left_out: dict[str, str] = field(default_factory=dict)

    def add(self, chain: EventChain) -> None:
        """Follow a chain, or note why that is not possible."""
        try:
            context = self.resources.context
            if crosses(chain, context.dataflow):
                ways = MessageRoutes(self.resources.executors.messages).of(chain)
            else:
                ways = routes_of_paths(unfold(chain, context.system)[0], context.dataflow)
            for route in (route for found in ways.values() for route in found):
                self._check(route)
            for events, found in ways.items():
                for route in found:
                    self._route(chain, " -> ".join(events) if len(found) == 1 else route_text(route), route)
        except UnknownError as error:
            self.left_out[chain.name] = str(error)

    def _check(self, route: Route) -> None:
        for link, (first, then) in zip(route.links, pairwise(route.events), strict=True):
            if link.kind in _NOT_FOLLOWED:
                raise UnknownError(f"from {first!r} to {then!r} it follows {link.kind}, which is not followed")
            for label in link.names if link.kind is LinkKind.DATA else ():
                for name in self.resources.context.touching.writers(label):
                    if name not in self.resources.processes:
                        raise UnknownError(f"{name!r}, which is not simulated, writes {label!r}")
        for occurrence in route.occurrences:
            if occurrence.process.name not in self.resources.processes:
                raise UnknownError(f"it passes {occurrence.process.name!r}, which is not simulated")
            transmission = self.resources.context.system.transmissions.get(occurrence.process.name)
            if transmission is not None and transmission.purpose is not Purpose.FOREIGN:
                self._check_message(transmission)

    def _check_message(self, transmission: Transmission) -> None:
        if transmission.purpose is Purpose.DATA and transmission.agent.simulated.most is None:
            raise UnknownError(f"it is not specified how long {transmission.name!r} takes in the agent")
        if reason := self.resources.executors.messages.obstacle(transmission):
            raise UnknownError(reason)

    def _route(self, chain: EventChain, text: str, found: Route) -> None:
        image = self.resources.image
        route = image.record(layout.ROUTE_SIZE, {layout.ROUTE_NUMBER: len(self.routes)})
        self.routes.append(FollowedRoute(chain.name, text))
        entity = self.resources.entities.number(EntityKind.CHAIN, chain.name)
        parts = stages(found, self.resources.context.settings.communication)
        records: list[dict[str, int]] = []
        for number, stage in enumerate(parts):
            is_last = number == len(parts) - 1
            needed = (1 << len(self._positions(stage))) - 1
            fields = {
                layout.ROUTE: route,
                layout.CHAIN_ENTITY: entity,
                layout.STEP: number,
                layout.NEEDED: needed,
                layout.IS_LAST: int(is_last),
                layout.CAPTURE: -1,
            }
            fields |= dict.fromkeys((layout.VALUE, layout.TAKEN, layout.LINK, layout.OUT), -1)
            if records:
                fields[layout.BEFORE_STAGE] = self._handed_over(parts[number - 1], records[-1], stage)
            processes = self.resources.executors.messages.host.threads_beside(stage.process.name)
            records.append({process: image.record(layout.STAGE_SIZE, fields) for process in processes})
        for stage, by_process in zip(parts, records, strict=True):
            for process, record in by_process.items():
                self._stage(replace(stage, process=self.resources.context.system.processes[process]), record)

    def _handed_over(self, before: Stage, stages: Mapping[str, int], stage: Stage) -> int:
        """Where a stage finds what the one before has passed on: there, or where a message puts it that carries it."""
        messages, record = self.resources.executors.messages, stages[before.process.name]
        transmissions = messages.system.transmissions
        sent = transmissions.get(before.process.name)
        publisher, subscription = self._on_host(before), self._on_host(stage)
        if publisher is not None or subscription is not None:
            source, target = publisher or sent, subscription or transmissions.get(stage.process.name)
            assert source is not None
            assert target is not None
            received = self.resources.image.record(layout.STAGE_SIZE, {layout.LINK: -1})
            messages.carry_on_host(source, target, stages, received + layout.LINK)
            return received
        if sent is None or sent.name == stage.process.name:
            return record
        taken_by: Transmission | tuple[str, str] | None = transmissions.get(stage.process.name)
        if taken_by is None:
            ready = taker(sent, messages.system)
            if ready is None:
                return record
            taken_by = (ready[0].name, ready[1].name)
        found = self.resources.image.record(layout.STAGE_SIZE, {layout.LINK: -1})
        messages.carry(sent, record + layout.LINK, taken_by, found + layout.LINK)
        return found

    def _on_host(self, stage: Stage) -> HostCallback | None:
        """The callback of the host in which a stage is."""
        host = self.resources.executors.messages.host
        return host.callback_at(stage.positions[-1]) if stage.positions else None

    def _positions(self, stage: Stage) -> list[ActivityPosition]:
        """The positions that a job must reach, each once."""
        found = {position.number: position for position in stage.positions}
        # One bit is for each, in a word of 64.
        return [found[number] for number in sorted(found)][:60]

    def _stage(self, stage: Stage, record: int) -> None:
        hooks = self.hooks.setdefault(stage.process.name, ProgramHooks())
        messages = self.resources.executors.messages
        if stage.process.name in messages.sent_again:
            messages.keep(stage.process.name, record)
        self._enter(stage, record, hooks)
        for index, position in enumerate(self._positions(stage)):
            hooks.before.setdefault(position.number, []).append((layout.REACH, record, 1 << index))
        if isinstance(stage.enter, At):
            self._begin(stage.enter, record, hooks)
        self._leave(stage, record, hooks)

    def _enter(self, stage: Stage, record: int, hooks: ProgramHooks) -> None:
        """Where a stage takes what it passes on."""
        is_captured, position, has_snapshot = stage.is_triggered, None, False
        match stage.enter:
            case Read(communication=communication, position=where) if not stage.is_triggered:
                is_captured = communication is Communication.LET
                position = None if is_captured else where
                has_snapshot = communication is Communication.IMPLICIT
            case Pass():
                position = stage.positions[0] if stage.positions else None
        is_first = isinstance(stage.enter, At)
        hooks.start.append((layout.ENTER, record, int(position is None and not is_first)))
        if is_captured:
            captures = self.captures.setdefault(stage.process.name, [])
            words = self.resources.image.words
            words[record + layout.CAPTURE] = len(captures)
            captures.append(words[record + layout.BEFORE_STAGE] + layout.LINK)
        if position is not None:
            hooks.before.setdefault(position.number, []).append((layout.TAKE, record, int(has_snapshot)))

    def _begin(self, at: At, record: int, hooks: ProgramHooks) -> None:
        """Where the stimulus of the chain occurs."""
        when, position = at.occurrence.when, at.occurrence.position
        if at.communication is Communication.LET or when is JobPhase.ACTIVATION:
            # The host has sent a message before it is queued on the wire.
            is_sent = at.occurrence.process.name in self.resources.executors.messages.transmissions
            hooks.start.append((layout.MARK, record, 2 if is_sent else 1))
        elif when is JobPhase.START:
            hooks.start.append((layout.MARK, record, 0))
        elif position is None:
            hooks.end.append((layout.MARK, record, 0))
        else:
            self._at(when, position, hooks).append((layout.MARK, record, 0))

    def _leave(self, stage: Stage, record: int, hooks: ProgramHooks) -> None:
        """Where a stage passes on what it has, or responds."""
        match stage.leave:
            case Write(communication=Communication.LET):
                self._publish(stage.process, record, hooks)
            case Write(communication=Communication.EXPLICIT, position=ActivityPosition() as position):
                hooks.after.setdefault(position.number, []).append((layout.PUT, record, 0))
            case Pass() if stage.positions:
                hooks.after.setdefault(stage.positions[-1].number, []).append((layout.PUT, record, 0))
            case Write() | Fire(position=None) | Pass():
                hooks.end.append((layout.LEAVE, record, 0))
            case Fire(position=ActivityPosition() as position, is_before=is_before):
                # Before the operation that fires: a trigger fires at its own operation, an event when its activity ends.
                side = hooks.before if is_before or not _raises_event(position) else hooks.after
                side.setdefault(position.number, []).append((layout.PUT, record, 0))
            case At(communication=Communication.LET):
                self._publish(stage.process, record, hooks)
            case At(occurrence=occurrence):
                if occurrence.position is not None:
                    self._at(occurrence.when, occurrence.position, hooks).append((layout.RESPOND, record, 0))
                else:
                    # Only at its end is it known which job has taken part.
                    is_sent = occurrence.when is JobPhase.END and self._gets_to_host(stage.process.name)
                    messages = self.resources.executors.messages
                    if is_sent and stage.process.name in messages.sent_again:
                        hooks.end.append((layout.LEAVE, record, 0))
                        messages.respond(stage.process.name, record)
                        return
                    hooks.end.append((layout.RESPOND, record, layout.AT_HOST if is_sent else _RESPONSE_TIMES[occurrence.when]))
            case boundary:
                raise UnknownError(f"it leaves a process in a way that is not followed: {type(boundary).__name__}")

    def _gets_to_host(self, process: str) -> bool:
        transmission = self.resources.executors.messages.system.transmissions.get(process)
        return (
            transmission is not None
            and transmission.direction is Direction.TO_AGENT
            and process in self.resources.executors.messages.transmissions
        )

    def _publish(self, process: Process, record: int, hooks: ProgramHooks) -> None:
        hooks.end.append((layout.PUBLISH, record, 0))
        self.let_stages.setdefault(process.name, []).append(record)

    def _at(self, when: JobPhase, position: ActivityPosition, hooks: ProgramHooks) -> list[Operation]:
        side = hooks.before if when is JobPhase.BEFORE else hooks.after
        return side.setdefault(position.number, [])


def _raises_event(position: ActivityPosition) -> bool:
    return not isinstance(position.activity, Trigger)
