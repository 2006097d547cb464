"""The messages that the host and controllers send to a controller: how often they really come, instead of what is stated.

A subscription on a controller states an interval and a jitter. If callbacks of the host or of a controller, this one included, publish
its topic, both follow from these: the controller is analysed with the interval of the publisher, and with the greater jitter. What it
sends depends on that in turn, so that all sides are analysed until nothing changes (K. Richter 2005). If no interval and jitter
describe what is sent, or the description contradicts itself, it is unknown how often the messages come, and so is everything that
depends on them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from amalthea_uros.analyze.host.releases import HostReleases
from amalthea_uros.analyze.host.topics import HostTopics, delayed
from amalthea_uros.analyze.host.unknown_times import why_unknown, with_unknown_times
from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.executors import Handle
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission, plain_topic
from amalthea_uros.perf.stimuli import Periodic, RelativePeriodic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.relays import latency_between, relayed
from amalthea_uros.timing.event_models.derived import AggregatedEventModel, aggregated, periodic_bound
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents
from amalthea_uros.units import Time, time_text

#: If the jitter still grows after so many analyses of both sides, the last difference is reported.
_MAX_PASSES = 30


def with_messages_of_others(described: System, solution: Solution) -> Solution:
    """The solution in which messages come as the host and others send them; what was stated otherwise becomes a finding.

    Parameters
    ----------
    solution : with the messages as stated
    """
    stated = solution.context.system
    releases = _releases(stated, solution)
    for _ in range(_MAX_PASSES):
        system = solution.context.system
        for transmission in handed_over(releases):
            system = _with_real_times(system, transmission, releases)
        if system is solution.context.system:
            break
        solution = _solved(system, solution)
        releases = _releases(stated, solution)
    return _checked(described, stated, solution, releases)


def _checked(described: System, stated: System, solution: Solution, releases: HostReleases) -> Solution:
    """The solution with a finding about each message that is not as stated; unknown is what depends on those without known times."""
    changed = _changes(stated, solution)
    unknown: dict[Transmission, _Unknown] = {}
    # What a controller sends can be unknown because of what it receives, and make unknown what others receive.
    while more := {each: why for each, why in _without_known_times(releases, changed) if each not in unknown}:
        unknown |= more
        system = solution.context.system
        for transmission, why in more.items():
            system = with_unknown_times(system, transmission, why.reason, described)
        solution = _solved(system, solution)
        releases = _releases(stated, solution)
    senders = {each.name: _sender(each, releases) for each in handed_over(releases)}
    for handle, after in changed:
        solution.context.notes.warning("HST003", _change(handle, after, senders[handle.transmission or ""]), handle)
    for transmission, why in unknown.items():
        if why.is_contradiction:
            publisher = next(iter(releases.topics.publishers(plain_topic(transmission.topic))), transmission)
            solution.context.notes.error("HST004", why.reason, publisher)
    return solution


def _solved(system: System, before: Solution) -> Solution:
    """The solution for changed messages, with the work of those before."""
    solution = solve(timing_context(system, before.context.settings))
    solution.jobs += before.jobs
    return solution


def _releases(stated: System, solution: Solution) -> HostReleases:
    """The releases on the host, whose work becomes part of that of the solution."""
    releases = HostReleases(HostTopics(stated.host, solution)).solve()
    solution.jobs += releases.jobs
    return releases


class _Unknown(NamedTuple):
    """Why it is unknown how often a message comes, and whether that contradicts what is described."""

    reason: str
    is_contradiction: bool = False


def _without_known_times(
    releases: HostReleases, changed: Sequence[tuple[Handle, Handle]]
) -> Iterator[tuple[Transmission, _Unknown]]:
    """The messages of which it is not known how often they come."""
    intervals = {handle.transmission: handle for handle, after in changed if handle.interval != after.interval}
    for transmission in handed_over(releases):
        topic, sender = plain_topic(transmission.topic), _sender(transmission, releases)
        try:
            if difference := violated(transmission, releases):
                yield transmission, _Unknown(difference, is_contradiction=True)
            elif handle := intervals.get(transmission.name):
                yield transmission, _Unknown(f"{sender} can send {topic!r} in another interval than {handle.name!r} states")
        except UnknownError as error:
            yield transmission, _Unknown(f"it is not known how often {sender} can send {topic!r}: {error}")


def _changes(stated: System, solution: Solution) -> list[tuple[Handle, Handle]]:
    """The subscriptions with other intervals or jitters than stated: as stated, and as analysed."""
    handles = {handle.name: handle for executor in solution.context.system.executors for handle in executor.handles}
    pairs = ((handle, handles[handle.name]) for executor in stated.executors for handle in executor.handles)
    return [(one, other) for one, other in pairs if (one.interval, one.jitter) != (other.interval, other.jitter)]


def _sender(transmission: Transmission, releases: HostReleases) -> str:
    """Who sends a message to a controller."""
    if releases.topics.publishers(plain_topic(transmission.topic)):
        return "the host"
    return "the controller itself" if _is_own(transmission, releases) else "another controller"


def _is_own(transmission: Transmission, releases: HostReleases) -> bool:
    """Whether only the controller itself publishes what it receives."""
    publishers = releases.topics.publishers(plain_topic(transmission.topic))
    sent = relayed(transmission, releases.topics.solved.context.system)
    return not publishers and all(each.wire == transmission.wire for each in sent)


def _interval(real: PeriodicEvents, transmission: Transmission, releases: HostReleases) -> Time:
    """The interval for which a controller is analysed: its own messages may be rarer than stated, as nothing relies on them to come."""
    stated = releases.topics.solved.event_models.get(transmission.name)
    if isinstance(stated, PeriodicEvents) and _is_own(transmission, releases):
        return min(stated.period, real.period)
    return real.period


def _change(stated: Handle, analysed: Handle, sender: str) -> str:
    message = f"{sender} can send the messages of {stated.name!r} every {time_text(analysed.interval or 0)}"
    if stated.interval == analysed.interval:
        return f"{message} with a jitter of up to {time_text(analysed.jitter)}, which is used instead of what the subscription states"
    return f"{message}, but the subscription states {time_text(stated.interval or 0)}, so that what depends on them is unknown"


def handed_over(releases: HostReleases) -> list[Transmission]:
    """The messages that the host or a controller sends to a controller, its own ones among them."""
    topics, system = releases.topics, releases.topics.solved.context.system
    return [
        each
        for each in system.network.transmissions
        if each.direction is Direction.TO_CONTROLLER
        and each.purpose is Purpose.DATA
        and (topics.publishers(plain_topic(each.topic)) or relayed(each, system))
    ]


def violated(transmission: Transmission, releases: HostReleases) -> str:
    """How the messages of the publishers differ from those that were analysed, or why these are unknown; "" if they do not.

    Raises
    ------
    UnknownError : it is not known how often they come.
    """
    if reason := why_unknown(transmission, releases.topics.solved.context.system):
        return reason
    topic, stated = plain_topic(transmission.topic), releases.topics.solved.event_models.get(transmission.name)
    published, agent = _published(transmission, releases), _agent_jitter(transmission)
    if isinstance(published, AggregatedEventModel):
        return f"more than one publisher sends {topic!r}, so that the interval of {transmission.callback!r} is not that of the messages"
    real = periodic_bound(published)
    if real is None or not isinstance(stated, PeriodicEvents):
        return f"no interval and jitter describe how often {_sender(transmission, releases)} can send {topic!r}"
    interval = _interval(real, transmission, releases)
    if interval != stated.period or real.jitter + agent > stated.jitter or stated.min_interarrival:
        times = f"every {time_text(real.period)} with a jitter of up to {time_text(real.jitter)}"
        return f"{_sender(transmission, releases)} can send {topic!r} {times}, for which the controller is not analysed"
    return ""


def _published(transmission: Transmission, releases: HostReleases) -> EventModel:
    """The messages when they reach the agent.

    Raises
    ------
    UnknownError : their number has no bound.
    """
    topic, topics = plain_topic(transmission.topic), releases.topics
    why = f"the latency of the topic {topic!r} is not specified"
    events = [delayed(releases.published(each), _spread(topics.latency(topic), why)) for each in topics.publishers(topic)]
    system = topics.solved.context.system
    for sent in relayed(transmission, system):
        events.append(delayed(topics.from_controller(sent), _spread(latency_between(sent, transmission, system), why)))
    return aggregated(tuple(events))


def _agent_jitter(transmission: Transmission) -> Time:
    return _spread(transmission.agent, "the latency of the agent is not specified")


def _spread(span: Span, reason: str) -> Time:
    if span.most is None:
        raise UnknownError(reason)
    return span.most - span.least


def _with_real_times(system: System, transmission: Transmission, releases: HostReleases) -> System:
    """The system with the interval and at least the jitter of the publisher; the same object if it has them or they are unknown."""
    try:
        if not violated(transmission, releases):
            return system
        real, agent = periodic_bound(_published(transmission, releases)), _agent_jitter(transmission)
    except UnknownError:
        return system
    stimuli = [each for each in system.stimuli.stimuli if each.name in system.processes[transmission.name].stimuli]
    handles = [handle for each in system.executors for handle in each.handles if handle.transmission == transmission.name]
    arriving = stimuli[0] if len(stimuli) == 1 else None
    # The task of a callback outside executors has a period that was chosen for what is stated.
    if not handles or not isinstance(arriving, Periodic | RelativePeriodic) or real is None:
        return system
    jitter = max(real.jitter, *(handle.jitter for handle in handles))
    interval = _interval(real, transmission, releases)
    changed = {handle: replace(handle, interval=interval, jitter=jitter) for handle in handles}
    late = Uniform(lower=0, upper=jitter + agent)
    if isinstance(arriving, RelativePeriodic):  # what is stated without any jitter
        stimulus = Periodic(name=arriving.name, period=interval, jitter=late, origin=arriving.origin)
    else:
        stimulus = replace(arriving, period=interval, jitter=late, min_distance=None)
    executors = tuple(
        replace(each, handles=tuple(changed.get(handle, handle) for handle in each.handles)) for each in system.executors
    )
    others = tuple(stimulus if each is arriving else each for each in system.stimuli.stimuli)
    return replace(system, executors=executors, stimuli=replace(system.stimuli, stimuli=others))
