"""Plays the loop of one executor alone on its core, step by step after rclc and rmw_microxrcedds; independent of the analysis.

Times are in microseconds. What is not known is chosen by a random generator: the part of the overhead before the wait, and how long
publications wait for their acknowledgements.
"""

from collections import deque
from dataclasses import dataclass, field

from amalthea_uros.perf.executors import HandleKind, LoopKind
from amalthea_uros.units import MICROSECOND as US

MS = 1000


@dataclass
class Run:
    """What happened: (handle, release, start, end) of each call, and the handles of which something was lost."""

    calls: list = field(default_factory=list)
    lost: set = field(default_factory=set)


def play(executor, costs, spin, messages, triggers, chance, until):
    """Play a loop until a time.

    Parameters
    ----------
    costs : of the callbacks, by the names of handles
    messages : (time, handle) of all messages in the order of their arrival
    triggers : (time, handle) of all triggers of guard conditions
    """
    return _Player(executor, costs, spin, deque(messages), deque(triggers), chance).run(until)


class _Player:
    def __init__(self, executor, costs, spin, messages, triggers, chance):
        self.executor, self.costs, self.spin = executor, costs, spin
        self.messages, self.triggers, self.chance = messages, triggers, chance
        self.timeout = executor.loop.timeout // US
        self.due = {each.name: each.phase // US for each in executor.handles if each.kind is HandleKind.TIMER}
        self.pool = {each.name: deque() for each in executor.handles}
        self.flags = {}
        self.receives = any(
            not self.due.keys() & {each.name} and each.kind is not HandleKind.GUARD_CONDITION for each in executor.handles
        )
        self.now, self.found = 0, Run()

    def run(self, until):
        loop, invocation = self.executor.loop, 0
        while self.now < until:
            self.round()
            if loop.kind is LoopKind.SPIN_PERIOD:
                left = invocation + loop.period // US - self.now
                self.now += max(0, left // MS * MS)
                invocation += loop.period // US
            else:
                self.now += loop.sleep // US
            # Time goes on in any case.
            self.now += 1 if not self.spin and not loop.sleep else 0
        return self.found

    def round(self):
        before = self.chance.randint(0, self.spin)
        self.now += before
        self.wait()
        ready = self.ready()
        self.now += self.spin - before
        taken = {}
        if self.executor.takes_first:
            taken = {handle.name: self.take(handle) for handle in ready}
        for handle in ready:
            release = taken[handle.name] if handle.name in taken else self.take(handle)
            start = self.now
            self.now += self.costs[handle.name]
            for publication in handle.publications:
                self.publish(publication)
            if release is not None:
                self.found.calls.append((handle.name, release, start, self.now))

    def wait(self):
        pending = [due - self.now for due in self.due.values()]
        timeout = max(0, min([self.timeout, *pending])) // MS * MS if self.receives else 0
        if self.messages and self.messages[0][0] <= self.now + timeout:
            self.now = max(self.now, self.messages[0][0])
            self.store(*self.messages.popleft())
        else:
            self.now += timeout
        while self.triggers and self.triggers[0][0] <= self.now:
            time, name = self.triggers.popleft()
            if name in self.flags:
                self.found.lost.add(name)
            else:
                self.flags[name] = time

    def store(self, time, name):
        handle = next(each for each in self.executor.handles if each.name == name)
        if len(self.pool[name]) >= handle.depth:
            self.found.lost.add(name)
            if not handle.overwrites:
                return
            self.pool[name].popleft()
        elif sum(map(len, self.pool.values())) >= self.executor.waiting.slots:
            self.found.lost.add(name)
            return
        self.pool[name].append(time)

    def ready(self):
        return [
            handle
            for handle in self.executor.handles
            if handle.always
            or self.pool[handle.name]
            or handle.name in self.flags
            or self.due.get(handle.name, self.now + 1) <= self.now
        ]

    def take(self, handle):
        """The release of what is served; None for a call without a message."""
        if handle.name in self.due:
            due, period = self.due[handle.name], handle.interval // US
            following = due + period
            while following <= self.now:
                following += period
                self.found.lost.add(handle.name)
            self.due[handle.name] = following
            return due
        if handle.kind is HandleKind.GUARD_CONDITION:
            return self.flags.pop(handle.name)
        return self.pool[handle.name].popleft() if self.pool[handle.name] else None

    def publish(self, publication):
        if publication.waits:
            self.now += self.chance.choice((0, publication.timeout // US, self.chance.randint(0, publication.timeout // US)))
            while self.messages and self.messages[0][0] <= self.now:
                self.store(*self.messages.popleft())
