"""Contradictions in the description of a host, and parts of it that are probably not meant so."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import combinations
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.network import ActionPart, conversation, plain_topic, request_topic, response_topic
from amalthea_uros.spec import host as spec
from amalthea_uros.spec.application import NodeSection
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.host_callbacks import AnyCallback, callbacks_of, published_by, topic_of

AnyNode: TypeAlias = spec.HostNodeSection | NodeSection


@dataclass(frozen=True, slots=True)
class HostChecks:
    """The checks of a host before it is built.

    Attributes
    ----------
    nodes : of all controllers
    """

    section: spec.HostSection
    nodes: Sequence[NodeSection]
    problems: Notes

    def report(self) -> None:
        """Add a finding for each mistake."""
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
        self._check_sources()
        self._check_messages()
        self._check_services()
        self._check_groups()
        self._check_threads()

    def _check_services(self) -> None:
        """Report calls that no service of the host answers, and responses of which it is not described who gets them."""
        nodes, problems = self.section.nodes, self.problems
        services = [(node, each) for node in nodes for each in node.services]
        clients = [(node, each) for node in nodes for each in node.clients]
        problems.unique("service of the host", ((each.service, each.location("service")) for _, each in services))
        names = {plain_topic(each.service) for _, each in services}
        names |= {plain_topic(each.name) for node in self.nodes for each in node.services}
        actions = [plain_topic(each.name) for node in self.nodes for each in node.action_servers]
        called, answered = {*names, *map(ActionPart.GOALS.of, actions)}, {*names, *map(ActionPart.RESULTS.of, actions)}
        calls = [(node, each, service) for node in nodes for each in callbacks_of(node) for service in each.calls]
        for _, caller, service in calls:
            if plain_topic(service) not in called:
                problems.undefined("service", service, called, caller.location("calls"))
        for _, client in clients:
            if plain_topic(client.service) not in answered:
                problems.undefined("service", client.service, answered, client.location("service"))
        self._check_callers([(node, service) for node, _, service in calls], {*map(conversation, called)})
        problems.unique("client of a service", ((each.service, each.location("service")) for _, each in clients))

    def _check_callers(self, calls: Iterable[tuple[AnyNode, str]], conversations: Collection[str]) -> None:
        """Report clients of services that other nodes call, too."""
        nodes: list[AnyNode] = [*self.section.nodes, *self.nodes]
        clients = [(node, each.service, each.location("service")) for node in nodes for each in node.clients]
        actions = [(node, each) for node in self.nodes for each in node.action_clients]
        clients += [(node, ActionPart.GOALS.of(each.action), each.location("action")) for node, each in actions]
        callers = [*calls, *((node, service) for node, service, _ in clients)]
        for _, service, location in clients:
            called = {id(other): other.name for other, each in callers if conversation(each) == conversation(service)}
            if len(called) > 1 and conversation(service) in conversations:
                message = f"the service {service!r} is called in the nodes {', '.join(sorted(called.values()))}"
                self.problems.error(
                    "APP003",
                    f"{message}, but which response is for which of them is not covered",
                    location,
                    "Describe calls and the client of a service in one node, or a service of its own for each of them.",
                )

    def _check_sources(self) -> None:
        """Report topics whose rate follows from what publishes them, and those that nothing publishes or takes."""
        problems, nodes = self.problems, self.nodes
        topics = {plain_topic(each.topic): each for each in self.section.topics}
        rates = {name for name, topic in topics.items() if topic.rate is not None}
        published = {topic for each in self._callbacks() for topic in published_by(each)}
        published |= {plain_topic(each.topic) for node in nodes for each in node.publishers}
        taken = {plain_topic(each.topic) for node in nodes for each in node.subscriptions}
        called = {each.service for node in nodes for each in node.clients}
        served = {each.name for node in nodes for each in node.services}
        sends = {each.action for node in nodes for each in node.action_clients}
        acts = {each.name for node in nodes for each in node.action_servers}
        goals, results = ActionPart.GOALS.of, ActionPart.RESULTS.of
        published |= {*map(request_topic, {*called, *map(goals, sends)}), *map(response_topic, {*served, *map(results, acts)})}
        published |= {plain_topic(ActionPart.FEEDBACK.of(action)) for action in acts}
        taken |= {*map(response_topic, {*called, *map(results, sends)}), *map(request_topic, {*served, *map(goals, acts)})}
        taken |= {own for each in self._callbacks() if (own := topic_of(each)) is not None}
        for name, topic in topics.items():
            if name not in published | taken:
                problems.undefined("topic", topic.topic, published | taken, topic.location("topic"))
            if name in rates & published:
                message = f"the rate of {topic.topic!r} is stated, but follows from what publishes it"
                problems.error("APP003", message, topic.location("rate"), "Remove 'rate'.")
            if topic.jitter is not None and topic.rate is None:
                message = f"'jitter' of {topic.topic!r} has no effect without 'rate'"
                problems.error("APP003", message, topic.location("jitter"), "Set 'rate', or remove 'jitter'.")
        for callback in self._callbacks():
            if isinstance(callback, spec.HostSubscription) and (name := plain_topic(callback.topic)) not in published | rates:
                help_text = f"{problems.suggestion('topic', name, published)} Or set its 'rate' under 'topics' of the host."
                message = f"nothing publishes {callback.topic!r}, to which {callback.name!r} subscribes"
                problems.warning("HST005", message, callback.location("topic"), help_text)

    def _check_messages(self) -> None:
        """Report callbacks that send a message more than once."""
        for callback in self._callbacks():
            for key, names in (("publishes", callback.publishes), ("calls", callback.calls)):
                for name, count in Counter(map(plain_topic, names)).items():
                    if count > 1:
                        message = f"{callback.name!r} has {name!r} more than once in {key!r}, but only one message of a call is covered"
                        self.problems.error("APP003", message, callback.location(key), "Name it once.")

    def _check_groups(self) -> None:
        """Report callback groups without an effect, and variables that nothing writes."""
        kinds = {executor.name: executor.type for executor in self.section.executors}
        for node in self.section.nodes:
            used = {callback.group for callback in callbacks_of(node)}
            for group in node.groups:
                if group.name not in used:
                    self._doubt(f"no callback is in the group {group.name!r}", group, "Set 'group' of callbacks, or remove it.")
                elif group.type == "reentrant" and kinds.get(node.executor, "multi-threaded") != "multi-threaded":
                    message = f"callbacks of the group {group.name!r} cannot overlap: {node.executor!r} has one thread"
                    self._doubt(message, group, "Use a multi-threaded executor, or leave out the group.")
        written = {variable for each in self._callbacks() for variable in each.writes}
        for callback in self._callbacks():
            for variable in callback.reads:
                if variable not in written:
                    message = f"no callback of the host writes {variable!r}, which {callback.name!r} reads"
                    help_text = self.problems.suggestion("variable", variable, written)
                    self.problems.warning("HST005", message, callback.location("reads"), help_text)

    def _check_threads(self) -> None:
        """Report executors that call nothing, and those of equal priority on one core."""
        used = {node.executor for node in self.section.nodes}
        for executor in self.section.executors:
            if executor.name not in used:
                self._doubt(
                    f"no node is in the executor {executor.name!r}", executor, "Set 'executor' of a node to it, or remove it."
                )
        for one, other in combinations(self.section.executors, 2):
            first, second = one.thread, other.thread
            is_shared = first.core is not None and (one.computer, first.core) == (other.computer, second.core)
            if is_shared and first.priority is not None and first.priority == second.priority:
                message = f"{one.name!r} and {other.name!r} have the same priority {first.priority} on core {first.core}"
                self._doubt(f"{message}, so that each can hold up the other", other, "Give them different priorities.")

    def _callbacks(self) -> Iterator[AnyCallback]:
        return (callback for node in self.section.nodes for callback in callbacks_of(node))

    def _doubt(self, message: str, section: DescriptionSection, help_text: str) -> None:
        self.problems.warning("HST005", message, section.location(), help_text)
