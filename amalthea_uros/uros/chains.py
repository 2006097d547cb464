"""Event chains: paths of processes, runnables and labels as sequences of events."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise, product

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Location
from amalthea_uros.errors import ReadError, UnknownError
from amalthea_uros.perf import events as perf
from amalthea_uros.perf.constraints import LatencyConstraint, LatencyKind
from amalthea_uros.perf.host import HOST_EVENT, HostCallback
from amalthea_uros.perf.network import plain_topic
from amalthea_uros.perf.software import Label
from amalthea_uros.spec.requirements import Chain, Moment
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.dataflow.routes import is_linked
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.chain_members import ChainElement, MessageOfTopic, Topics, topic_error

_PROCESS_CHANGES: Mapping[Moment, perf.ProcessChange] = {
    "activation": perf.ProcessChange.ACTIVATE,
    "start": perf.ProcessChange.START,
    "finish": perf.ProcessChange.TERMINATE,
}


@dataclass(slots=True)
class ChainBuilder:
    """Builds event chains from the chains of the description, and their events.

    Attributes
    ----------
    elements : by the name that a path uses
    topics : which a path can contain, too
    dataflow : of the system, which has no events yet
    """

    elements: Mapping[str, ChainElement]
    topics: Topics
    dataflow: Dataflow
    notes: Notes
    events: dict[str, perf.Event] = field(default_factory=dict)
    chains: dict[str, perf.EventChain] = field(default_factory=dict)
    _seen: set[str] = field(default_factory=set)

    @property
    def host(self) -> Mapping[str, HostCallback]:
        """The callbacks of the host, which a path can contain, too."""
        return {callback.name: callback for callback in self.dataflow.system.host.callbacks}

    @property
    def host_topics(self) -> frozenset[str]:
        """The topics between callbacks of the host."""
        published = {topic for callback in self.host.values() for topic in callback.publishes}
        return frozenset(published & {callback.topic for callback in self.host.values() if callback.topic is not None})

    @property
    def labels(self) -> Mapping[str, Label]:
        """The labels."""
        return self.dataflow.system.labels

    def add_all(self, sections: Sequence[Chain]) -> tuple[LatencyConstraint, ...]:
        """Add all chains of the description, and return the limits of their latency."""
        by_name: dict[str, Chain] = {}
        for section in sections:
            if section.name in by_name:
                self.notes.duplicate("chain", section.name, section.location("name"), by_name[section.name].location("name"))
            by_name.setdefault(section.name, section)
        for section in by_name.values():
            self._add(section, by_name, ())
        return tuple(
            constraint for section in by_name.values() if section.name in self.chains for constraint in _limits(section)
        )

    def _add(self, section: Chain, by_name: Mapping[str, Chain], above: tuple[str, ...]) -> perf.EventChain | None:
        """Add a chain after the chains that it refers to."""
        if section.name in above:
            cycle = " -> ".join((*above[above.index(section.name) :], section.name))
            location = by_name[above[-1]].location("sequence")
            message = f"chain {section.name!r} contains itself: {cycle}"
            self.notes.error("APP004", message, location, "Remove one of these references.")
            return None
        if section.name in self._seen:
            return self.chains.get(section.name)
        self._seen.add(section.name)
        above = (*above, section.name)
        if section.path is not None:
            found = self._path(section)
        elif section.parallel is not None:
            found = self._parallel(section, section.parallel)
        else:
            found = self._sequence(section, section.sequence or [], by_name, above)
        if found is not None:
            self.chains[section.name] = found
        return found

    # Paths

    def _path(self, section: Chain) -> perf.EventChain | None:
        names = self._path_events(section, section.path or [], lambda index: section.location("path", index))
        if names is None:
            return None
        is_one_each = len(names) == len(section.path or [])  # a message has several events
        segments = tuple(
            perf.Segment(stimulus=first, response=then, origin=section.location("path", index if is_one_each else None))
            for index, (first, then) in enumerate(pairwise(names), start=1)
        )
        items = perf.Sequence(segments) if len(segments) > 1 else None
        return perf.EventChain(name=section.name, stimulus=names[0], response=names[-1], items=items, origin=section.location())

    def _path_events(self, section: Chain, path: Sequence[str], place: Callable[[int], Location | None]) -> list[str] | None:
        """The names of the events along a path; None, with a finding, if the path is invalid."""
        for index, name in enumerate(path):
            if name in path[:index]:
                message = f"{name!r} occurs twice in the path, but a chain cannot contain cycles"
                self.notes.error("APP004", message, place(index), "Split it into two chains, and join them with 'sequence'.")
                return None
        unknown = [index for index in range(len(path)) if not self._is_known(path[index])]
        for index in unknown:
            defined = {*self.elements, *self.labels, *self.topics.names, *self.host}
            kind = "topic" if path[index].startswith("/") else "process, runnable or label"
            self.notes.undefined(kind, path[index], defined, place(index))
        if unknown:
            return None
        if len(path) == 1 and self._is_topic(path[0]):
            message = f"the path only has the topic {path[0]!r}"
            self.notes.error("APP004", message, place(0), "Add the callback that receives or publishes it.")
            return None
        if self._is_label(path[0]) or (self._is_label(path[-1]) and path[-2] not in self.elements):
            index = 0 if self._is_label(path[0]) else len(path) - 1
            message = f"{path[index]!r} is a label without a process or runnable before it that writes it"
            advice = f"Add the process or runnable that writes {path[index]!r}."
            self.notes.error("APP004", message, place(index), advice)
            return None
        self._check_labels(path, place)
        try:
            found = [(index, event) for index in range(len(path)) for event in self._events_of(section, path, index, place)]
        except ReadError as error:
            self.notes.add_all(error.findings)
            return None
        names = self._connected(found, path, place)
        if names[0] == names[-1]:
            message = f"chain {section.name!r} starts and ends with the same event {names[0]!r}"
            self.notes.error("APP004", message, section.location(), "Change 'from' or 'to', or extend the path.")
            return None
        return names

    def _is_known(self, name: str) -> bool:
        return name in self.elements or name in self.labels or name in self.host or self._is_topic(name)

    def _is_topic(self, name: str) -> bool:
        is_topic = name in self.topics or plain_topic(name) in self.host_topics
        return is_topic and name not in self.elements and name not in self.labels and name not in self.host

    def _is_label(self, name: str) -> bool:
        return name in self.labels and name not in self.elements

    def _events_of(
        self, section: Chain, path: Sequence[str], index: int, place: Callable[[int], Location | None]
    ) -> Iterator[str]:
        """The events of a member of a path."""
        name = path[index]
        if name in self.host:
            yield from self._host_events(name, is_first=index == 0)
        elif self._is_topic(name):
            yield from self._topic_events(section, path, index, place)
        elif index == 0:
            yield self._event_at(name, section.start)
        elif name not in self.elements:
            yield self._write_event(path[index - 1], name)
        elif index == len(path) - 1:
            yield self._event_at(name, section.end)
        elif path[index + 1] in self.elements or self._is_topic(path[index + 1]):
            # An element that writes the next label of the path is represented by that write.
            yield self._event_at(name, "finish")

    def _topic_events(
        self, section: Chain, path: Sequence[str], index: int, place: Callable[[int], Location | None]
    ) -> Iterator[str]:
        """The events of the messages of a topic, and of the callbacks that send and receive them if the path does not name them.

        Raises
        ------
        ReadError : it is not clear which message is meant.
        """
        topic, rest = path[index], path[index + 1 :]
        is_to_host = bool(rest) and rest[0] in self.host
        if not (index > 0 and path[index - 1] in self.host) and (index > 0 or is_to_host):
            sent = self.topics.sent(topic, path[index - 1] if index else "", section.location())
            if sent.callback in path[: max(0, index - 1)]:
                message = f"{path[index - 1]!r} does not publish {topic!r}"
                raise topic_error(message, section.location(), f"Add the topic to the path after {sent.callback!r}.")
            if index and sent.callback != path[index - 1]:
                yield self._event_at(sent.callback, "finish")
            yield self._message_event(sent, topic, place(index))
        if not rest or is_to_host:
            return
        received = self.topics.received(topic, rest, section.location())
        yield self._message_event(received, topic, place(index))
        receiver, taken_by = self.elements[received.callback], self._taker(received.callback)
        takers = {element.process for element in (receiver, taken_by) if element is not None}
        if received.callback in rest[1:] and self._process(rest[0]) not in {*takers, *received.processes}:
            message = f"{rest[0]!r} does not receive {topic!r}"
            raise topic_error(message, section.location(), f"Add the topic to the path before {received.callback!r}.")
        known = {receiver.process, *received.processes, self._process(rest[0])}
        if taken_by is not None and taken_by.process not in known:
            yield self._event_at(receiver.taken_by or "", "finish")
        if received.callback not in rest:
            yield self._event_at(received.callback, "finish")

    def _host_events(self, name: str, is_first: bool) -> Iterator[str]:
        """The events that stand for a callback of the host."""
        for moment in ("start", "finish") if is_first else ("finish",):
            event = perf.CustomEvent(name=f"{name}_{moment}", kind=HOST_EVENT)
            self.events.setdefault(event.name, event)
            yield event.name

    def _message_event(self, message: MessageOfTopic, topic: str, location: Location | None) -> str:
        if not message.is_on_wire:
            text = (
                f"the latency of messages of {topic!r} is unknown, because no transport is described for {message.callback!r}"
            )
            self.notes.warning("CHN010", text, location, "Describe 'transport' and 'agent' of its middleware.")
        self.events.setdefault(message.event.name, message.event)
        return message.event.name

    def _taker(self, callback: str) -> ChainElement | None:
        """The element that takes the messages of a callback for its task; None if there is none."""
        return self.elements.get(self.elements[callback].taken_by or "")

    def _process(self, name: str) -> str | None:
        return self.elements[name].process if name in self.elements else None

    def _check_labels(self, path: Sequence[str], place: Callable[[int], Location | None]) -> None:
        """Note labels of the path that the member before does not write, or the one after does not read."""
        members = [(index, name) for index, name in enumerate(path) if name in self.elements]
        for (start, first), (end, then) in pairwise(members):
            for label in filter(self.labels.__contains__, path[start + 1 : end]):
                if label not in self.elements[first].writes:
                    self.notes.warning("UR130", f"{first!r} does not write {label!r}", place(start + 1))
                if label not in self.elements[then].reads:
                    self.notes.warning("UR130", f"{then!r} does not read {label!r}", place(end))
        if self._is_label(path[-1]) and path[-1] not in self.elements[path[-2]].writes:
            self.notes.warning("UR130", f"{path[-2]!r} does not write {path[-1]!r}", place(len(path) - 1))

    def _connected(
        self, events: Sequence[tuple[int, str]], path: Sequence[str], place: Callable[[int], Location | None]
    ) -> list[str]:
        """The events, with those by which a message comes back from the agent; members that nothing connects get a finding.

        Parameters
        ----------
        events : position in the path, and name
        """
        found = [events[0][1]]
        for (index, first), (_, then) in pairwise(events):
            members = path[index : index + 2]
            if len(members) == 2 and all(name in self.elements for name in members):
                taken_by = self._taken_by(*(self.elements[name] for name in members))
                if taken_by is not None and not self._is_direct(first, then):
                    found.append(self._event_at(taken_by, "finish"))
                elif not is_linked(self.events[first], self.events[then], self.dataflow):
                    message = f"no data flow or trigger connects {members[0]!r} to {members[1]!r}"
                    advice = f"Let {members[0]!r} write a label that {members[1]!r} reads, or trigger it."
                    self.notes.warning("UR130", message, place(index + 1), advice)
            found.append(then)
        return found

    def _taken_by(self, sender: ChainElement, receiver: ChainElement) -> str | None:
        """The element that takes the messages of one member for another one; None if there are none."""
        name = receiver.taken_by if sender.sends & receiver.receives else None
        return name if name in self.elements else None

    def _is_direct(self, first: str, then: str) -> bool:
        """Whether a label or a trigger connects two events, so that no message has to."""
        try:
            ends = product(*(self.dataflow.events.of(self.events[name]) for name in (first, then)))
        except UnknownError:
            return False
        return any(self.dataflow.data(*pair) or self.dataflow.triggers(*(end.process.name for end in pair)) for pair in ends)

    def _event_at(self, name: str, moment: Moment) -> str:
        """The event of a process or runnable at a moment of its job."""
        element = self.elements[name]
        title = f"{name}_{moment}"
        if element.runnable is None:
            event: perf.Event = perf.ProcessEvent(name=title, process=element.process, change=_PROCESS_CHANGES[moment])
        else:
            # A runnable has no activation of its own: it starts when it is called.
            change = perf.RunnableChange.TERMINATE if moment == "finish" else perf.RunnableChange.START
            event = perf.RunnableEvent(name=title, runnable=element.runnable, change=change, process=element.process)
        self.events.setdefault(title, event)
        return title

    def _write_event(self, writer: str, label: str) -> str:
        """The event of a write access to a label."""
        title = f"{label}_written_by_{writer}"
        element = self.elements.get(writer)
        process = element.process if element is not None else None
        # Other callbacks of an executor that loops can write it, too, and run at other times.
        runnable = element.runnable if element is not None and process in self.dataflow.system.executor_of_task else None
        event = perf.LabelEvent(name=title, label=label, change=perf.LabelChange.WRITE, process=process, runnable=runnable)
        self.events.setdefault(title, event)
        return title

    # Chains of chains

    def _sequence(
        self, section: Chain, names: Sequence[str], by_name: Mapping[str, Chain], above: tuple[str, ...]
    ) -> perf.EventChain | None:
        parts: list[perf.EventChain] = []
        for index, name in enumerate(names):
            if name not in by_name:
                self.notes.undefined("chain", name, by_name, section.location("sequence", index))
                continue
            part = self._add(by_name[name], by_name, above)
            if part is not None:
                parts.append(part)
        if len(parts) < len(names):
            return None
        for index, (before, after) in enumerate(pairwise(parts), start=1):
            if before.response != after.stimulus:
                message = f"{after.name!r} starts with {after.stimulus!r}, but {before.name!r} ends with {before.response!r}"
                advice = f"Set 'to' of {before.name!r} and 'from' of {after.name!r} to the same moment of the same element."
                self.notes.error("APP004", message, section.location("sequence", index), advice)
                return None
        items = perf.Sequence(tuple(perf.ChainReference(chain=part.name) for part in parts))
        return perf.EventChain(
            name=section.name, stimulus=parts[0].stimulus, response=parts[-1].response, items=items, origin=section.location()
        )

    def _parallel(self, section: Chain, paths: Sequence[Sequence[str]]) -> perf.EventChain | None:
        place = section.location("parallel")
        found = [names for path in paths if (names := self._path_events(section, path, lambda _: place)) is not None]
        if len(found) < len(paths):
            return None
        ends = {(names[0], names[-1]) for names in found}
        if len(ends) > 1 or any(len(names) < 3 for names in found):
            message = "parallel paths must have the same first and last element, and other elements in between"
            self.notes.error("APP004", message, place, "Change the paths, or define separate chains.")
            return None
        if section.completed > len(paths):
            message = f"'completed' is {section.completed}, but there are only {len(paths)} parallel paths"
            self.notes.error("APP004", message, section.location("completed"), f"Set 1 to {len(paths)}.")
        branches = tuple(
            perf.Segment(
                stimulus=names[0],
                response=names[-1],
                items=perf.Sequence(
                    tuple(perf.Segment(stimulus=first, response=then, origin=place) for first, then in pairwise(names))
                ),
                origin=place,
            )
            for names in found
        )
        items = perf.Parallel(items=branches, completed=section.completed)
        ((first, last),) = ends
        return perf.EventChain(name=section.name, stimulus=first, response=last, items=items, origin=section.location())


def _limits(section: Chain) -> list[LatencyConstraint]:
    found = []
    for kind, limits in ((LatencyKind.REACTION, section.reaction), (LatencyKind.AGE, section.age)):
        jitter = section.jitter if section.jitter is not None and section.jitter.of == kind else None
        stated = limits or jitter
        if stated is not None:
            found.append(
                LatencyConstraint(
                    name=f"{section.name}_{kind}",
                    chain=section.name,
                    kind=kind,
                    minimum=limits.min if limits else None,
                    maximum=limits.max if limits else None,
                    jitter=jitter.max if jitter else None,
                    origin=stated.location(),
                )
            )
    return found
