"""The tasks of a wire: what is queued on it, and when.

The agent sends at any time, but never more often than the description says. The controller sends at the end of callbacks. A timer of an
executor that loops is called once at most between two times at which it is due, and what it sends is sent before its next call: so
each message is at most two periods late. Acknowledgements follow each part of a reliable message: those of the agent when it has
processed the part, those of the controller when it has read it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import Call
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission
from amalthea_uros.perf.stimuli import Counter, Custom, InterProcess, Periodic, RelativePeriodic, Stimulus
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import body_name
from amalthea_uros.uros.application.messages import ASKING
from amalthea_uros.uros.assembly.executor_runnables import notification_name
from amalthea_uros.uros.middleware.profile import Heartbeat, Profile
from amalthea_uros.uros.transports.can import ForeignFrame
from amalthea_uros.uros.transports.line import Line, span_of, time_on
from amalthea_uros.uros.transports.messages import WireMessage, acknowledgement_name, opposite

_AT_ONCE = Span(most=0)
#: Why the arrivals of messages are unknown.
_MEAN_ONLY = "only the mean of 'to_controller' of the agent is known"


@dataclass(frozen=True, slots=True, kw_only=True)
class Sender:
    """A runnable that queues messages at its end.

    Attributes
    ----------
    times : how many each time
    """

    runnable: str
    times: int = 1
    counter: Counter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Queued:
    """What is queued on a wire.

    Attributes
    ----------
    parts : lengths of the messages of the middleware that are sent each time
    stimulus : None if it is not known when it is queued
    sender : triggers the stimulus; None if something else does
    answer : the stimulus that each part triggers when it has been sent
    interval : minimum time between two of them in the long run; None if it is not known
    times : how many there are in that interval; 0 for what is only sent when others are late
    channel : of the identifier; "" for none of its own
    frame : a foreign frame, instead of parts
    """

    transmission: Transmission
    parts: tuple[int, ...]
    stimulus: Stimulus | None
    interval: Time | None
    times: int = 1
    sender: Sender | None = None
    answer: str | None = None
    channel: str = ""
    frame: ForeignFrame | None = None
    origin: Location | None = None


@dataclass(frozen=True, kw_only=True)
class Queueing:
    """Decides what is queued on a wire.

    Attributes
    ----------
    system : of the application, without the wire
    receivers : processes that each received message passes
    """

    line: Line
    profile: Profile
    system: System
    receivers: tuple[str, ...]

    def of(self, messages: Iterable[WireMessage]) -> Iterator[Queued]:
        """What is queued for the messages of the application."""
        messages = tuple(messages)
        for message in messages:
            yield from self._received(message) if message.direction is Direction.TO_CONTROLLER else self._sent(message)
        for direction in Direction:
            heartbeat = self.profile.heartbeat(direction)
            if not heartbeat.is_answered:
                yield self._heartbeat(heartbeat, direction)
            elif any(each.direction is direction and each.message.reliable for each in messages):
                yield self._heartbeat(heartbeat, direction)
                yield self._answer(heartbeat, direction)

    def foreign(self, frame: ForeignFrame) -> Queued:
        """A foreign frame."""
        return Queued(
            transmission=Transmission(
                name=frame.name,
                wire=self.line.name,
                direction=Direction.TO_CONTROLLER,
                purpose=Purpose.FOREIGN,
                length=frame.data_bytes,
                agent=_AT_ONCE,
            ),
            parts=(),
            stimulus=None if frame.period is None else arrivals(frame.name, frame.period, frame.jitter, frame.origin),
            interval=frame.period,
            frame=frame,
            origin=frame.origin,
        )

    def _received(self, message: WireMessage) -> Iterator[Queued]:
        agent = span_of(self.profile.middleware.agent.to_controller)
        yield self._data(message, self._arrivals(message, agent), agent)
        if message.is_acknowledged:
            takes = self._takes.get(body_name(message.callback.name)) or notification_name(message.callback)
            reader = takes if takes in self.system.runnables else body_name(message.callback.name)
            yield self._acknowledgement(message, _AT_ONCE, Sender(runnable=reader, times=len(message.parts)))

    def _arrivals(self, message: WireMessage, agent: Span) -> Stimulus | None:
        """When the agent queues a message; None if it is unknown how much its times vary, also for a simulation."""
        if agent.most is not None:
            jitter = message.jitter + agent.most - agent.least
        elif message.callback.jitter:
            jitter = message.jitter  # it is that of the messages that leave the agent
        elif agent.mean is not None:
            return Custom(name=message.name, description=_MEAN_ONLY, origin=message.message.origin)
        else:
            return None
        return arrivals(message.name, message.interval, jitter, message.message.origin)

    def _sent(self, message: WireMessage) -> Iterator[Queued]:
        callback, agent = message.callback, span_of(self.profile.middleware.agent.to_host)
        body = body_name(callback.name)
        answer = acknowledgement_name(message.name) if message.is_acknowledged else None
        if body in self._looping_timers:
            own = [frame for part in message.parts for frame in self.line.frames(part.length, Direction.TO_AGENT)]
            distance = time_on(self.line, own)[0] if self.line.keeps_sender else 0
            stimulus = arrivals(message.name, message.interval, 2 * message.interval, message.message.origin, distance)
            yield self._data(message, stimulus, agent, answer=answer)
        else:
            runs = runs_per_message(callback.name, message.interval, self.system)
            sender = Sender(runnable=body, counter=Counter(prescaler=runs) if runs > 1 else None)
            stimulus = InterProcess(name=message.name, origin=message.message.origin)
            yield self._data(message, stimulus, agent, sender=sender, answer=answer)
        if answer is not None:
            yield self._acknowledgement(message, self._answer_time, None)

    @property
    def _answer_time(self) -> Span:
        """The time that the agent takes to acknowledge; the limit for the whole of it holds for the part of the agent, too."""
        stated = self.profile.middleware.agent.acknowledgement
        return Span(most=self.profile.middleware.transport.acknowledgement) if stated is None else span_of(stated)

    def _data(
        self,
        message: WireMessage,
        stimulus: Stimulus | None,
        agent: Span,
        sender: Sender | None = None,
        answer: str | None = None,
    ) -> Queued:
        return Queued(
            transmission=self._transmission(
                message.name, message.direction, Purpose.DATA, tuple(part.length for part in message.parts), agent, message
            ),
            parts=tuple(part.length for part in message.parts),
            stimulus=stimulus,
            interval=message.interval or None,
            times=message.message.attempts,
            sender=sender,
            answer=answer,
            channel=message.message.channel,
            origin=message.message.origin,
        )

    def _acknowledgement(self, message: WireMessage, agent: Span, sender: Sender | None) -> Queued:
        name = acknowledgement_name(message.name)
        length = max(part.acknowledgement or 0 for part in message.parts)
        return Queued(
            transmission=self._acknowledging(message.name, opposite(message.direction), length, agent, message),
            parts=(length,),
            stimulus=InterProcess(name=name, origin=message.message.origin),
            interval=message.interval or None,
            times=len(message.parts) * message.message.attempts,
            sender=sender,
            origin=message.message.origin,
        )

    def _heartbeat(self, heartbeat: Heartbeat, direction: Direction) -> Queued:
        name = heartbeat_name(direction)
        is_asked = heartbeat.is_answered and direction is Direction.TO_AGENT
        return Queued(
            transmission=self._transmission(name, direction, Purpose.HEARTBEAT, (heartbeat.length,), _AT_ONCE),
            parts=(heartbeat.length,),
            stimulus=arrivals(name, heartbeat.interval),
            interval=heartbeat.interval,
            times=0,
            answer=acknowledgement_name(name) if is_asked else None,
        )

    def _answer(self, heartbeat: Heartbeat, direction: Direction) -> Queued:
        """What answers a heartbeat in a direction."""
        name = acknowledgement_name(heartbeat_name(direction))
        by_agent = direction is Direction.TO_AGENT
        agent = self._answer_time if by_agent else _AT_ONCE
        return Queued(
            transmission=self._acknowledging(heartbeat_name(direction), opposite(direction), heartbeat.length, agent),
            parts=(heartbeat.length,),
            # The client answers when it reads: before it has to read the next one.
            stimulus=InterProcess(name=name) if by_agent else arrivals(name, heartbeat.interval, heartbeat.interval),
            interval=heartbeat.interval,
            times=0,
        )

    def _acknowledging(
        self, acknowledged: str, direction: Direction, length: int, agent: Span, message: WireMessage | None = None
    ) -> Transmission:
        """The acknowledgement of a transmission."""
        name = acknowledgement_name(acknowledged)
        found = self._transmission(name, direction, Purpose.ACKNOWLEDGEMENT, (length,), agent, message)
        return replace(found, acknowledges=acknowledged)

    def _transmission(
        self,
        name: str,
        direction: Direction,
        purpose: Purpose,
        parts: tuple[int, ...],
        agent: Span,
        message: WireMessage | None = None,
    ) -> Transmission:
        is_received = direction is Direction.TO_CONTROLLER
        is_answered = message is not None and purpose is Purpose.DATA and message.is_acknowledged
        is_asking = message is not None and message.message.kind in ASKING
        return Transmission(
            name=name,
            wire=self.line.name,
            direction=direction,
            purpose=purpose,
            topic=message.message.sent_as if message is not None and purpose is Purpose.DATA and not is_asking else None,
            callback=message.callback.name if message is not None else None,
            length=sum(parts),
            link=self.line.link,
            driver=_sum(self.line.reading(part) for part in parts) if is_received else _AT_ONCE,
            processes=self.receivers if is_received else (),
            agent=agent,
            waits=is_answered and not is_received and (is_asking or self.profile.middleware.reliable.waits),
            is_dropped_when_busy=purpose is Purpose.DATA and not is_received and self.profile.sending.drops_when_busy,
        )

    @cached_property
    def _takes(self) -> Mapping[str, str]:
        """The runnables that take messages, by those of their callbacks."""
        handles = (handle for executor in self.system.executors for handle in executor.handles)
        return {handle.runnable: handle.take for handle in handles if handle.take is not None}

    @cached_property
    def _looping_timers(self) -> frozenset[str]:
        """The runnables of timers that executors call that loop."""
        handles = (handle for executor in self.system.executors for handle in executor.handles)
        return frozenset(handle.runnable for handle in handles if handle.kind is HandleKind.TIMER)


def heartbeat_name(direction: Direction) -> str:
    """The name of what the middleware sends by itself in a direction."""
    return f"heartbeat_of_{'agent' if direction is Direction.TO_CONTROLLER else 'client'}"


def _sum(spans: Iterable[Span]) -> Span:
    found = list(spans)
    known = [span.most for span in found if span.most is not None]
    return Span(least=sum(span.least for span in found), most=sum(known) if len(known) == len(found) else None)


def arrivals(name: str, interval: Time, jitter: Time = 0, origin: Location | None = None, min_distance: Time = 0) -> Stimulus:
    """Messages that come after a minimum time, each of which can be late.

    Messages that are sent less often are never denser than those that are sent after exactly that time.

    Parameters
    ----------
    min_distance : of two messages, whatever their jitter
    """
    if jitter:
        late = Uniform(lower=0, upper=jitter)
        return Periodic(name=name, period=interval, jitter=late, min_distance=min_distance or None, origin=origin)
    distance = Uniform(lower=interval, upper=interval)
    return RelativePeriodic(name=name, distance=distance, has_maximum=False, origin=origin)


def runs_per_message(callback: str, interval: Time, system: System) -> int:
    """How often a callback runs for each message: more than once if it runs in every activation of a task of its own."""
    task = system.processes.get(callback)
    if task is None or any(isinstance(each, Call) and each.counter is not None for each in task.activities):
        return 1
    stimulus = system.stimuli_by_name[task.stimuli[0]]
    return max(1, interval // stimulus.period) if isinstance(stimulus, Periodic) else 1
