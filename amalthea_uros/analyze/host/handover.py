"""Whether the messages of the host are what the description of a controller states of them.

A subscription on a controller states how often messages come, and with which jitter. If callbacks of the host publish its topic, that
must hold for what they publish: the same interval, and no more jitter on the wire than the stated one and that of the agent.
"""

from __future__ import annotations

from amalthea_uros.analyze.host.results import HostResults
from amalthea_uros.analyze.host.topics import delayed
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.network import Direction, Purpose, Span, Transmission, plain_topic
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents, aggregated
from amalthea_uros.units import Time, time_text


def handed_over(host: HostResults) -> list[Transmission]:
    """The messages that the host sends to the controller."""
    topics = host.releases.topics
    return [
        each
        for each in topics.solved.context.system.network.transmissions
        if each.direction is Direction.TO_CONTROLLER
        and each.purpose is Purpose.DATA
        and topics.publishers(plain_topic(each.topic))
    ]


def violated(transmission: Transmission, host: HostResults) -> str:
    """How the messages of the host differ from what is stated of them; "" if they do not.

    Raises
    ------
    UnknownError : it is not known how often they come.
    """
    releases, topic = host.releases, plain_topic(transmission.topic)
    topics = releases.topics
    events = [releases.published(each) for each in topics.publishers(topic)]
    # The agent sends back what the controller publishes, too.
    events += [topics.from_controller(each) for each in topics.transmissions(topic, Direction.TO_AGENT)]
    sent = aggregated(tuple(events))
    late = _spread(topics.latency(topic), f"the latency of the topic {topic!r} is not specified")
    agent = _spread(transmission.agent, "the latency of the agent is not specified")
    stated = topics.solved.event_models.get(transmission.name)
    if stated is None:
        raise UnknownError(f"the rate of {topic!r} is not specified at {transmission.callback!r}")
    return _difference(delayed(sent, late), stated, agent, transmission)


def _difference(real: EventModel, stated: EventModel, agent: Time, transmission: Transmission) -> str:
    """The difference between what reaches the agent and what is stated, which includes the jitter of the agent."""
    topic = plain_topic(transmission.topic)
    if not isinstance(real, PeriodicEvents) or not isinstance(stated, PeriodicEvents):
        return f"it is not known whether the messages of {topic!r} come as seldom as stated"
    if real.period != stated.period:
        return f"the host publishes {topic!r} every {time_text(real.period)}, and an interval of {time_text(stated.period)} is stated"
    jitter = real.jitter + agent
    if jitter > stated.jitter or (stated.min_interarrival and real.period - jitter < stated.min_interarrival):
        late = time_text(real.jitter)
        return f"the host publishes {topic!r} with a jitter of up to {late}, and {transmission.callback!r} states less"
    return ""


def _spread(span: Span, reason: str) -> Time:
    if span.most is None:
        raise UnknownError(reason)
    return span.most - span.least
