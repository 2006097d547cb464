"""The host of a description: its computers, executors and topics, with findings about what contradicts itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.host import (
    Host,
    HostCallback,
    HostComputer,
    HostExecutor,
    HostExecutorKind,
    HostPolicy,
    HostThread,
    HostTopic,
    RosRelease,
)
from amalthea_uros.perf.network import Span, plain_topic
from amalthea_uros.spec import host as spec
from amalthea_uros.spec.application import NodeSection
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.uros.application.callbacks import interval_of_rate
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.host_callbacks import callbacks_of, kind_of, published_by, topic_of
from amalthea_uros.uros.host_checks import HostChecks
from amalthea_uros.uros.transports.line import span_of


def host_of(section: spec.HostSection | None, nodes: Sequence[NodeSection], problems: Notes) -> Host:
    """The host that a section describes; an empty one if there is none.

    Parameters
    ----------
    nodes : of all controllers
    """
    return Host() if section is None else _HostBuilder(section, problems).host(nodes)


@dataclass(frozen=True, slots=True)
class _HostBuilder:
    section: spec.HostSection
    problems: Notes

    def host(self, nodes: Sequence[NodeSection]) -> Host:
        """The host; see `host_of`."""
        section = self.section
        HostChecks(section, nodes, self.problems).report()
        return Host(
            release=RosRelease(section.ros),
            computers=tuple(
                HostComputer(name=each.name, cores=each.cores, isolated=tuple(each.isolated), origin=each.location())
                for each in section.computers
            ),
            executors=tuple(map(self._executor, section.executors)),
            topics=tuple(self._topics()),
        )

    def _executor(self, section: spec.HostExecutorSection) -> HostExecutor:
        computers = {computer.name: computer for computer in self.section.computers}
        computer = section.computer
        if computer is None and len(computers) > 1:
            message = f"the computer of {section.name!r} is not specified"
            self.problems.error("APP003", message, section.location(), f"Set 'computer' to one of {', '.join(computers)}.")
        elif computer is not None and computer not in computers:
            self.problems.undefined("computer", computer, computers, section.location("computer"))
        thread = _thread(section.thread)
        cores = computers[computer].cores if computer in computers else self.section.computers[0].cores
        if beyond := next((core for core in thread.cores if core >= cores), None):
            message = f"{section.name!r} runs on core {beyond}, but the computer has the cores 0 to {cores - 1}"
            self.problems.error(
                "APP003", message, section.thread.location(), "Correct the number of the core, or set 'cores' of the computer."
            )
        nodes = [node for node in self.section.nodes if node.executor == section.name]
        return HostExecutor(
            name=section.name,
            computer=computer or self.section.computers[0].name,
            kind=HostExecutorKind(section.type),
            thread=thread,
            threads=section.threads or 1,
            callbacks=tuple(callback for node in nodes for callback in self._of_node(node)),
            origin=section.location(),
        )

    def _of_node(self, node: spec.HostNodeSection) -> Iterator[HostCallback]:
        reentrant = {group.name for group in node.groups if group.type == "reentrant"}
        for section in callbacks_of(node):
            yield HostCallback(
                name=section.name,
                kind=kind_of(section),
                execution=self._execution(section.execution_time),
                period=section.period if isinstance(section, spec.HostTimer) else None,
                topic=topic_of(section),
                depth=10 if isinstance(section, spec.HostTimer) else section.depth,
                publishes=tuple(published_by(section)),
                reads=tuple(section.reads),
                writes=tuple(section.writes),
                group=f"{node.name}/{section.group or ''}",
                is_reentrant=section.group in reentrant,
                origin=section.location(),
            )

    def _execution(self, section: ExecutionTimeSection) -> Span:
        """The bounds of an execution time; a distribution between them is not used."""
        if section.on is not None:
            message = "execution times by platform are those of controllers"
            self.problems.error(
                "APP003", message, section.location("on"), "State 'min' and 'max' on the computer of the callback."
            )
            return Span()
        if section.histogram is not None:
            return Span(least=min(each.min for each in section.histogram), most=max(each.max for each in section.histogram))
        # Of a Weibull distribution, some values are above 'max'.
        return Span(least=section.min or 0, most=None if section.exceeding else section.max)

    def _topics(self) -> Iterator[HostTopic]:
        """The topics that are described, and those that only callbacks name."""
        stated = {plain_topic(each.topic): each for each in self.section.topics}
        callbacks = [callback for node in self.section.nodes for callback in callbacks_of(node)]
        named = [topic for each in callbacks for topic in published_by(each)]
        named += [taken for each in callbacks if (taken := topic_of(each)) is not None]
        for name in dict.fromkeys((*stated, *named)):
            topic = stated.get(name)
            latency = topic.latency if topic is not None and topic.latency is not None else self.section.latency
            yield HostTopic(
                name=name,
                latency=span_of(latency),
                interval=None if topic is None or topic.rate is None else interval_of_rate(topic.rate),
                jitter=(topic.jitter or 0) if topic is not None else 0,
                origin=(topic or self.section).location(),
            )


def _thread(section: spec.ThreadSection) -> HostThread:
    cores = (section.core,) if section.core is not None else tuple(section.cores or ())
    return HostThread(
        policy=HostPolicy(section.policy),
        priority=section.priority or 0,
        cores=cores,
        budget=section.budget or 0,
        period=section.period or 0,
    )
