"""When executors in loops begin iterations, and send messages: as often as what makes them do so, and late by what bounds it.

- A publication of a callback follows what the callback is called for: a message, an expiration, or a trigger, each of which leads to
  one call at most. It is sent between the earliest and the latest end of the callback after that, so that the difference is its
  jitter. A timer that is late keeps its grid, so that a message is at most two periods late, whatever the iterations take. Only of a
  timer that is never a period late is each expiration followed by a message.
- Between the same instants of two calls of a callback are a whole callback, with what it waits for, the overhead of an iteration, and
  the sleep: a minimum distance that holds without any of these bounds. A message that is sent at different places of the callback has
  only the rest of the iteration between two of them, and the whole callback as jitter (`sending_places`).
- The agent acknowledges a publication that waits, and does not time out, before the callback ends, so that the same holds for that.
- The client acknowledges each part of a message, and each heartbeat, when it reads it: at most the greatest age of the receive backlog
  after its arrival, and the rest of the cycle.
- An iteration of a loop without a sleep ends at most the longest response time, and the rest of the iteration, after what began it.

Each follows from response times that follow from how often messages are sent: all of them together are the least solution of these
equations, as for event models in general (K. Richter 2005), and in docs/proofs/receive-backlog.md.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.backlog import Arriving, acknowledged, asks_again, times_out
from amalthea_uros.executors.bounds.cycle import Cycle
from amalthea_uros.executors.bounds.evaluate import handle_result
from amalthea_uros.executors.bounds.missing import MissingMessages, missing_messages, waits_for_missing
from amalthea_uros.executors.bounds.publications import sending_times
from amalthea_uros.executors.bounds.sending_places import sending_places
from amalthea_uros.executors.bounds.sent_again import sent_again
from amalthea_uros.executors.bounds.solved_system import SolvedSystem
from amalthea_uros.executors.bounds.transmissions import arrival_jitter
from amalthea_uros.executors.results import ExecutorOccurrences, HandleResult, merged
from amalthea_uros.executors.semantics.losses import parts, recovers
from amalthea_uros.executors.semantics.readiness import arrivals, reads_in_waits
from amalthea_uros.executors.semantics.suspension import acknowledgements
from amalthea_uros.perf.executors import Handle, HandleKind, Publication
from amalthea_uros.perf.network import Span
from amalthea_uros.perf.stimuli import InterProcess
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models.derived import Delayed, Multiplied
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents, SingleEvent, SporadicEvents
from amalthea_uros.units import Time


def least_occurrences(context: TimingContext) -> ExecutorOccurrences:
    """Fewer occurrences than any, with which a search for consistent ones can begin."""
    executors = context.system.executors
    published = [each for executor in executors for handle in executor.handles for each in _sent_by(handle, context)]
    names = [name for each in published for name in (each.transmission, each.acknowledgement) if name is not None]
    return ExecutorOccurrences(
        sent=dict.fromkeys((*names, *_acknowledgements_of_executors(context)), SingleEvent()),
        lateness={executor.task: Time(0) for executor in executors},
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageTimes:
    """How long messages hold up who sends them, and when they arrive.

    Attributes
    ----------
    sending : times from the call of publish to its return, by the names of transmissions
    missing : what losses lead to, by the names of transmissions
    jitter : of arrivals, by the names of handles
    """

    sending: Mapping[str, Span]
    missing: Mapping[str, MissingMessages | str]
    jitter: Mapping[str, Time | None]

    @classmethod
    def of(cls, solved: SolvedSystem) -> MessageTimes:
        """The times of messages that follow from response times and activations."""
        sending = sending_times(solved)
        missing = missing_messages(solved, sending)
        return cls(sending=sending, missing=missing, jitter=arrival_jitter(solved, waits_for_missing(missing)))

    @classmethod
    def merged(cls, times: Iterable[MessageTimes]) -> MessageTimes:
        """The times of the messages of all controllers."""
        every = list(times)
        return cls(
            sending=merged(each.sending for each in every),
            missing=merged(each.missing for each in every),
            jitter=merged(each.jitter for each in every),
        )

    @property
    def waits(self) -> dict[str, Time | None]:
        """How long reliable messages can wait for missing ones, by the names of transmissions; None if that has no bound."""
        return waits_for_missing(self.missing)


def occurrences(solved: SolvedSystem) -> ExecutorOccurrences:
    """The occurrences that follow from response times and activations."""
    times_of_messages = MessageTimes.of(solved)
    sending, missing, extra_jitter = times_of_messages.sending, times_of_messages.missing, times_of_messages.jitter
    sent: dict[str, EventModel | None] = {}
    lateness: dict[str, Time | None] = {}
    times: list[Time | None] = []
    overrunning: set[str] = set()
    cycles: list[Cycle | None] = []
    for executor in solved.context.system.executors:
        try:
            cycle = Cycle.of(executor, solved, sending)
        except UnknownError:
            cycles.append(None)
            lateness[executor.task] = None
            overrunning.add(executor.task)
            sent |= {each.transmission or "": None for handle in executor.handles for each in _sent_by(handle, solved.context)}
            times += [None] * reads_in_waits(executor)
            continue
        results = [handle_result(handle, cycle, extra_jitter) for handle in executor.handles]
        cycles.append(cycle)
        lateness[executor.task] = _lateness(cycle, results)
        overrunning |= {executor.task} if cycle.can_overrun else set()
        times += [_until_acknowledged(cycle)] * reads_in_waits(executor)
        for handle, result in zip(executor.handles, results, strict=True):
            for publication in _sent_by(handle, solved.context):
                sent |= _published(publication, _calls(handle, publication, result, cycle, extra_jitter), cycle)
    # Executors that share a buffer read what each other waits for.
    late = None if None in times else max(filter(None, times), default=Time(0))
    arriving = acknowledged(solved)
    written = {name: _acknowledging(arriving[name], late) for name in _acknowledgements_of_executors(solved.context)}
    again = _by_controller(cycles, solved)
    for name, effect in missing.items():
        if isinstance(effect, str):
            again[name] = effect
        elif effect.again is not None:
            again[name] = effect.again
    return ExecutorOccurrences(sent=sent | written, lateness=lateness, again=again, overrunning=frozenset(overrunning))


def _by_controller(cycles: Sequence[Cycle | None], solved: SolvedSystem) -> dict[str, EventModel | str]:
    """Messages that the controller sends again; the cycle of any executor bounds the age of the receive backlog."""
    known = [each for each in cycles if each is not None]
    ages = [each.greatest_age for each in known] if len(known) == len(cycles) else []
    processor = known[0].processor if known else None
    distances = [each.publication_distance for each in known]
    return sent_again(solved, _least(ages), processor, _least(distances))


def _least(times: Sequence[Time | None]) -> Time | None:
    return min((time for time in times if time is not None), default=None)


def _published(publication: Publication, calls: EventModel | None, cycle: Cycle) -> Mapping[str, EventModel | None]:
    """The messages of some calls, and their acknowledgements if nothing else is known of these, by the names of transmissions."""
    system, acknowledgement = cycle.solved.context.system, publication.acknowledgement or ""
    if calls is not None and publication.attempts > 1 and asks_again(publication, cycle.sending):
        calls = Multiplied(calls, publication.attempts)
    sent = {publication.transmission or "": calls}
    if calls is None or times_out(publication, cycle.sending) or acknowledgement not in system.transmissions:
        return sent
    count = parts(system.transmissions[acknowledgement], system)
    return {**sent, acknowledgement: calls if count == 1 else Multiplied(calls, count)}


def _sent_by(handle: Handle, context: TimingContext) -> Iterator[Publication]:
    """The publications of a handle whose messages nothing else sends; of timers, also those whose times are stated."""
    for each in handle.publications:
        name = each.transmission or ""
        senders = [other for executor in context.system.executors for other in executor.handles if _sends(other, name)]
        if name not in context.system.transmissions or len(senders) > 1:
            continue
        if handle.kind is HandleKind.TIMER or _is_triggered(name, context):
            yield each


def _sends(handle: Handle, transmission: str) -> bool:
    return any(publication.transmission == transmission for publication in handle.publications)


def _acknowledgements_of_executors(context: TimingContext) -> Iterator[str]:
    """The acknowledgements of what executors read, and no process besides them."""
    if any(map(reads_in_waits, context.system.executors)):
        for each in acknowledgements(context.system):
            if each.callback is None or _is_triggered(each.name, context):
                yield each.name


def _is_triggered(name: str, context: TimingContext) -> bool:
    """Whether executors in loops send a transmission, and nothing else does."""
    senders = set(context.activations.triggering(name))
    stimuli = map(context.system.stimuli_by_name.get, context.system.processes[name].stimuli)
    return context.system.executor_of_task.keys() >= senders and all(isinstance(each, InterProcess) for each in stimuli)


def _calls(
    handle: Handle, publication: Publication, result: HandleResult, cycle: Cycle, extra_jitter: Mapping[str, Time | None]
) -> EventModel | None:
    """When the calls of a handle publish; None if nothing bounds that."""
    places = sending_places(handle, publication, cycle.executor.task, cycle.solved.context)
    if places is None:
        return None
    between = cycle.shortest_with(handle) if places.is_same else cycle.shortest
    distance = max(between if places.most == 1 else 0, _shortest_write(publication, cycle.solved))
    ready = _made_ready(handle, extra_jitter)
    worst, late = result.response.worst, None
    if worst is not None:
        late = worst - (result.response.best if places.is_same else 0)
    if ready is not None and handle.kind is HandleKind.TIMER:
        late = min(2 * ready.period, 2 * ready.period if late is None else late)
    if ready is None or late is None:
        return SporadicEvents(distance) if distance else None
    # A timer can lose expirations of which it is late, and a message can find its queue full.
    is_each = handle.kind is HandleKind.TIMER and worst is not None and worst <= ready.period
    # What is missing stays in its buffer, until no more is sent.
    is_each = is_each and not recovers(publication, cycle.solved.context.system)
    calls = (type(ready) if is_each else SporadicEvents)(ready.period, ready.jitter + late, distance if places.most == 1 else 0)
    return calls if places.most == 1 else Multiplied(calls, places.most)


def _shortest_write(publication: Publication, solved: SolvedSystem) -> Time:
    """How long a thread writes a message at least: until it is on the wire, if its driver keeps it so long."""
    network, message = solved.context.system.network, solved.context.system.transmissions[publication.transmission or ""]
    keeps_sender = any(wire.keeps_sender for wire in network.wires if wire.name == message.wire)
    return solved.bcet(message.name) if keeps_sender else 0


def _made_ready(handle: Handle, extra_jitter: Mapping[str, Time | None]) -> PeriodicEvents | None:
    """The events of which each leads to one call of a handle; None if they are unknown."""
    if handle.kind is HandleKind.LOOP_ITEM:
        return SporadicEvents(handle.interval) if handle.interval else None
    if handle.always or handle.sources > 1:
        return None
    try:
        return arrivals(handle, extra_jitter)
    except UnknownError:
        return None


def _lateness(cycle: Cycle, results: Sequence[HandleResult]) -> Time | None:
    """How long after what began it an iteration can end; None if that has no bound."""
    busy, times = cycle.busy, [cycle.longest, *(result.response.worst for result in results)]
    known = [time for time in times if time is not None]
    return None if busy is None or len(known) < len(times) else max(known) + busy


def _until_acknowledged(cycle: Cycle) -> Time | None:
    """From the arrival of a message until it has been read and acknowledged; None if that has no bound."""
    return None if cycle.backlog_age is None or cycle.longest is None else cycle.backlog_age + cycle.longest


def _acknowledging(arriving: Arriving | None, late: Time | None) -> EventModel | None:
    return None if arriving is None or late is None else Delayed(arriving.as_events, late)
