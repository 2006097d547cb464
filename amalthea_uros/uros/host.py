"""The host of a description: its computers, executors and topics, with findings about what contradicts itself."""

from __future__ import annotations

from collections.abc import Collection, Iterator

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
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.uros.application.callbacks import interval_of_rate
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.host_callbacks import callbacks_of, kind_of, published_by, topic_of


def host_of(section: spec.HostSection | None, published: Collection[str], problems: Notes) -> Host:
    """The host that a section describes; an empty one if there is none.

    Parameters
    ----------
    published : the topics that controllers publish
    """
    return Host() if section is None else _HostBuilder(section, problems).host(published)


def topics_of_nodes(application: Application) -> set[str]:
    """The topics that nodes of a controller publish."""
    return {plain_topic(each.topic) for node in application.nodes for each in node.publishers}


@dataclass(frozen=True, slots=True)
class _HostBuilder:
    section: spec.HostSection
    problems: Notes

    def host(self, published: Collection[str]) -> Host:
        """The host; see `host_of`."""
        section = self.section
        self._check(published)
        return Host(
            release=RosRelease(section.ros),
            computers=tuple(
                HostComputer(name=each.name, cores=each.cores, isolated=tuple(each.isolated), origin=each.location())
                for each in section.computers
            ),
            executors=tuple(map(self._executor, section.executors)),
            topics=tuple(self._topics()),
        )

    def _check(self, published: Collection[str]) -> None:
        section, problems = self.section, self.problems
        for kind, items in (
            ("computer", section.computers),
            ("executor of the host", section.executors),
            ("node", section.nodes),
        ):
            problems.unique(kind, ((each.name, each.location("name")) for each in items))
        problems.unique("topic", ((plain_topic(each.topic), each.location("topic")) for each in section.topics))
        callbacks = [callback for node in section.nodes for callback in callbacks_of(node)]
        problems.unique("callback of the host", ((each.name, each.location("name")) for each in callbacks))
        executors = {executor.name for executor in section.executors}
        for node in section.nodes:
            if node.executor not in executors:
                problems.undefined("executor of the host", node.executor, executors, node.location("executor"))
            groups = {group.name for group in node.groups}
            for callback in callbacks_of(node):
                if callback.group is not None and callback.group not in groups:
                    problems.undefined(
                        "callback group", callback.group, groups, callback.location("group"), owner=f"node {node.name!r}"
                    )
        for computer in section.computers:
            if beyond := next((core for core in computer.isolated if core >= computer.cores), None):
                message = f"{computer.name!r} has no core {beyond}, but the cores 0 to {computer.cores - 1}"
                problems.error(
                    "APP003", message, computer.location("isolated"), "Correct the number of the core, or set 'cores'."
                )
        self._check_sources(published)
        self._check_services()

    def _check_services(self) -> None:
        """Report calls that no service of the host answers, and responses of which it is not described who gets them."""
        nodes, problems = self.section.nodes, self.problems
        services = [(node, each) for node in nodes for each in node.services]
        clients = [(node, each) for node in nodes for each in node.clients]
        problems.unique("service of the host", ((each.service, each.location("service")) for _, each in services))
        names = {each.service for _, each in services}
        callers = [(node, each, service) for node in nodes for each in callbacks_of(node) for service in each.calls]
        for _, caller, service in callers:
            if service not in names:
                problems.undefined("service of the host", service, names, caller.location("calls"))
        for node, client in clients:
            others = {other.name for other, _, service in callers if service == client.service and other is not node}
            others |= {other.name for other, each in clients if each.service == client.service and other is not node}
            if client.service not in names:
                problems.undefined("service of the host", client.service, names, client.location("service"))
            elif others:
                message = f"the service {client.service!r} is called in the nodes {', '.join(sorted({node.name, *others}))}"
                problems.error(
                    "APP003",
                    f"{message}, but which response is for which of them is not covered",
                    client.location("service"),
                    "Describe calls and the client of a service in one node.",
                )
        self.problems.unique("client of a service", ((each.service, each.location("service")) for _, each in clients))

    def _check_sources(self, published: Collection[str]) -> None:
        """Report topics whose rate is stated although it follows from what publishes them."""
        own = {plain_topic(topic) for node in self.section.nodes for each in callbacks_of(node) for topic in each.publishes}
        for topic in self.section.topics:
            if topic.rate is not None and plain_topic(topic.topic) in own.union(published):
                message = f"the rate of {topic.topic!r} is stated, but follows from what publishes it"
                self.problems.error("APP003", message, topic.location("rate"), "Remove 'rate'.")
            if topic.jitter is not None and topic.rate is None:
                message = f"'jitter' of {topic.topic!r} has no effect without 'rate'"
                self.problems.error("APP003", message, topic.location("jitter"), "Set 'rate', or remove 'jitter'.")

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
                latency=Span() if latency is None else Span(least=latency.min, most=latency.max),
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
