"""Messages that loops send outside of callbacks, as callbacks of the executors that stand for them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.spec.application import CallbackSection, NodeSection
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.loops import LoopItem
from amalthea_uros.units import SECOND, Time
from amalthea_uros.uros.application.callbacks import Callback
from amalthea_uros.uros.application.messages import Message, MessageKind, publication
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.executors.threads import ThreadItems, threads_with_items
from amalthea_uros.uros.middleware.profile import Profile


def loop_callbacks(description: Description, profile: Profile, findings: Notes) -> Iterator[Callback]:
    """A callback for each item of a loop that sends, with a finding for each topic without a publisher."""
    nodes = description.application.nodes
    for thread in threads_with_items(description.middleware):
        sent = [each for part in thread.parts for each in part.sent]
        if sent and not nodes:
            text = f"the loop of {thread.owner!r} sends, but the application has no node"
            findings.error("APP003", text, sent[0].item.location(), "Define the node under 'application', with its publishers.")
            continue
        of_thread = _ThreadCallbacks(thread, thread.pace(description.os), nodes, profile, findings)
        for part in thread.parts:
            for item in part.sent:
                yield of_thread.callback(*item, part.name)


@dataclass(frozen=True, slots=True)
class _ThreadCallbacks:
    """Makes the callbacks of a thread.

    Attributes
    ----------
    pace : least time between two passes of its loop
    """

    thread: ThreadItems
    pace: Time
    nodes: Sequence[NodeSection]
    profile: Profile
    findings: Notes

    def callback(self, name: str, item: LoopItem, executor: str) -> Callback:
        """The callback of an item."""
        interval = item.every if item.every is not None else self.pace
        at_once = ExecutionTimeSection.model_construct(min=0, max=0)
        section = CallbackSection.model_construct(name=name, execution_time=at_once, publishes=item.publish or [])
        section._where = item._where
        if not interval and self.profile.middleware.transport.can is not None:
            text = f"nothing keeps the messages apart that {name!r} sends on the CAN bus: the loop has no sleep"
            self.findings.error("APP003", text, item.location(), "State 'every', the least time between two of them.")
            interval = SECOND
        return Callback(
            section=section,
            kind=HandleKind.LOOP_ITEM,
            node=self._node(item),
            interval=item.every,
            executor=executor,
            in_executor=True,
            incoming=None,
            outgoing=tuple(self._messages(item, name, interval)),
            buffer=None,
        )

    def _node(self, item: LoopItem) -> NodeSection:
        """The node of the publisher."""
        topics = item.publish or ()
        return next((node for node in self.nodes if any(each.topic in topics for each in node.publishers)), self.nodes[0])

    def _messages(self, item: LoopItem, name: str, interval: Time) -> Iterator[Message]:
        for index, topic in enumerate(item.publish or ()):
            place = item.location("publish", index)
            message = publication(name, topic, self._node(item), self.nodes, interval, place, self.findings)
            if message is not None:
                yield message
        asked = MessageKind.PING if item.ping is not None else MessageKind.SYNC if item.sync is not None else None
        if asked is None:
            return
        if not self.profile.replies_to_pings:
            text = f"{self.profile.title} has no {asked}"
            self.findings.error("APP003", text, item.location(), "Remove the item, or set another middleware.")
        attempts, longest = item.attempts or 1, item.ping if item.ping is not None else item.sync
        yield Message(
            callback=name,
            topic=name,
            kind=asked,
            size=0,
            interval=interval,
            reliable=False,
            origin=item.location(),
            attempts=attempts,
            timeout=(longest or 0) + attempts * self.profile.replies_late,
        )
