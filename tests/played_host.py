"""Executors of a host tick by tick, on one core by fixed priority; written from the sources of rclcpp, it knows nothing of the product.

At one instant, first callbacks end, then messages arrive and timers become due, and then threads decide. Times are whole ticks.
"""

from collections import defaultdict, deque
from dataclasses import dataclass, field


@dataclass
class Callback:
    """A timer (period), or the subscription of a topic; `sends` are topics with a latency each."""

    name: str
    worst: int
    best: int
    period: int = 0
    topic: str = ""
    depth: int = 10
    sends: dict[str, int] = field(default_factory=dict)


@dataclass
class Thread:
    """An executor; kinds: single, batch (static up to iron), first (static since jazzy), events.

    A ready set is in the order of registration within a kind, or in any other one at each poll.
    """

    kind: str
    priority: int
    callbacks: list[Callback]
    queues: dict[str, deque] = field(default_factory=lambda: defaultdict(deque))
    due: dict[str, int] = field(default_factory=dict)
    ready: list[Callback] = field(default_factory=list)
    events: deque = field(default_factory=deque)
    running: list | None = None
    is_ordered: bool = False

    def arrive(self, callback, now, root):
        """Put a message in the queue of a subscription."""
        if self.kind == "events":
            self.events.append((callback, now, root))
            return
        queue = self.queues[callback.name]
        if len(queue) == callback.depth:
            queue.popleft()
        queue.append((now, root))

    def expire(self, now):
        """The timer thread of an events executor calls due timers at once."""
        for callback in self.callbacks:
            while self.kind == "events" and callback.period and self.due[callback.name] <= now:
                self.events.append((callback, self.due[callback.name], self.due[callback.name]))
                self.due[callback.name] += callback.period

    def order(self, random):
        """The callbacks as a poll lists them: timers first but in static executors."""
        mixed = self.callbacks if self.is_ordered else random.sample(self.callbacks, len(self.callbacks))
        return sorted(mixed, key=lambda each: bool(each.period) is (self.kind in ("batch", "first")))

    def is_ready(self, callback, now):
        """Whether a poll finds the callback."""
        return self.due[callback.name] <= now if callback.period else bool(self.queues[callback.name])

    def take(self, now, random):
        """The next callback with its release and that of its root; None if there is none."""
        if self.kind == "events":
            return self.events.popleft() if self.events else None
        if not self.ready:
            self.ready = [each for each in self.order(random) if self.is_ready(each, now)]
            if self.kind == "first":
                self.ready = self.ready[:1]
        if not self.ready:
            return None
        callback = self.ready.pop(0)
        if not callback.period:
            return (callback, *self.queues[callback.name].popleft())
        release = self.due[callback.name]
        while self.due[callback.name] <= now:
            self.due[callback.name] += callback.period
        return callback, release, release


def play(threads, sources, horizon, random):
    """The longest times of each callback, from its own release and from that of the head of its chain.

    Parameters
    ----------
    sources : topic -> arrivals from outside, in order
    """
    own, whole = defaultdict(int), defaultdict(int)
    coming = defaultdict(list)
    for topic, times in sources.items():
        for time in times:
            coming[time].append((topic, None))
    for now in range(horizon):
        for topic, root in coming.pop(now, ()):
            for thread in threads:
                for callback in thread.callbacks:
                    if callback.topic == topic:
                        thread.arrive(callback, now, now if root is None else root)
        for thread in threads:
            thread.expire(now)
        for thread in sorted(threads, key=lambda each: -each.priority):
            if thread.running is None and (taken := thread.take(now, random)) is not None:
                thread.running = [*taken, random.choice([taken[0].worst, random.randint(taken[0].best, taken[0].worst)])]
            if thread.running is None:
                continue
            thread.running[3] -= 1
            if not thread.running[3]:
                callback, release, root, _ = thread.running
                own[callback.name] = max(own[callback.name], now + 1 - release)
                whole[callback.name] = max(whole[callback.name], now + 1 - root)
                for topic, latency in callback.sends.items():
                    # What arrives at the end itself is there before what has been on its way.
                    place = 0 if latency == 0 else len(coming[now + 1 + latency])
                    coming[now + 1 + latency].insert(place, (topic, root))
                thread.running = None
            break
    return own, whole
