"""Plays executors step by step, as rclc and the middleware of micro-ROS do, from the rules of their sources alone.

ros2/rclc rclc/src/rclc/executor.c, micro-ROS/rcl src/rcl/{timer,wait}.c, micro-ROS/rmw_microxrcedds src/{rmw_wait,callbacks,types}.c.
"""

from collections import deque
from dataclasses import dataclass, field
from random import Random

from executor_kernel import Kernel, Listen, Lock, Mutex, Run, Signal, Until

from amalthea_uros.perf.executors import HandleKind, LoopKind, TriggerKind

MS = 10**9
WITHOUT_MESSAGES = (HandleKind.TIMER, HandleKind.GUARD_CONDITION, HandleKind.LOOP_ITEM)


@dataclass
class Seen:
    """What was seen of a handle.

    Attributes
    ----------
    responses : from releases to ends of callbacks
    lateness : from releases to starts of callbacks
    lost : how many were lost in one go, for each time
    by_pool : how many messages were dropped for want of a slot
    waiting : ages of what nobody had served at the end
    """

    responses: list = field(default_factory=list)
    lateness: list = field(default_factory=list)
    lost: list = field(default_factory=list)
    by_pool: int = 0
    waiting: list = field(default_factory=list)


@dataclass
class SeenLoop:
    loops: list = field(default_factory=list)
    rounds: list = field(default_factory=list)


@dataclass
class Spans:
    """Least and greatest execution times and times of sending; `draw` gives one of a span."""

    costs: dict
    spins: dict
    sending: dict
    draw: object


class Session:
    """What executors share: the mutex, messages on their way that nobody has read, and slots."""

    def __init__(self, slots):
        self.slots, self.mutex, self.signal = slots, Mutex(), Signal()
        self.unread, self.entities = deque(), []

    def store(self):
        """Read a message; what is stored beyond the depth or the slots is lost."""
        entity, release = self.unread.popleft()
        handle = entity.handle
        if handle.depth is not None and len(entity.stored) >= handle.depth:
            if handle.overwrites:
                entity.stored.popleft()
                entity.stored.append(release)
            entity.missed()
        elif self.slots is not None and sum(len(each.stored) for each in self.entities) >= self.slots:
            entity.seen.by_pool += 1
            entity.missed()
        else:
            entity.stored.append(release)


class Entity:
    """A handle while it is played."""

    def __init__(self, handle, seen):
        self.handle, self.seen = handle, seen
        self.stored, self.due, self.flag, self.ready = deque(), None, None, None
        self.lost = 0

    @property
    def is_timer(self):
        return self.handle.kind is HandleKind.TIMER

    @property
    def is_guard(self):
        return self.handle.kind is HandleKind.GUARD_CONDITION

    @property
    def is_item(self):
        return self.handle.kind is HandleKind.LOOP_ITEM

    def missed(self):
        self.lost += 1
        self.seen.lost.append(self.lost)

    def trigger(self, now):
        """A guard condition is triggered: its flag stays as it is if it is set already."""
        if self.flag is None:
            self.flag = now
        else:
            self.missed()

    def look(self, now):
        """After the wait: whether it is ready, for the rest of the round."""
        if self.is_timer or self.is_item:
            self.ready = self.due <= now
        elif self.is_guard:
            self.ready, self.taken, self.flag = self.flag is not None, self.flag, None
            self.lost = 0
        else:
            self.ready = bool(self.stored)

    def take(self, now):
        """The release of what is served now; None for a call without data. Nothing releases an item of a loop but its turn."""
        if not self.ready:
            return None
        self.lost = 0
        if self.is_item:
            return now
        if self.is_timer or self.is_guard:
            return self.taken if self.is_guard else self.due
        return self.stored.popleft() if self.stored else None

    def advance(self, now):
        """Call of a timer: whole periods that have passed are lost; an item of a loop is due an interval later."""
        if self.is_item:
            self.due = now + (self.handle.interval or 0)
            return
        period = self.handle.interval
        self.due += period
        if self.due <= now:
            skipped = (now - self.due) // period + 1
            self.due += skipped * period
            self.seen.lost.append(skipped)


class Played:
    """An executor while it is played."""

    def __init__(self, executor, kernel, session, spans, random, start):
        self.model, self.kernel, self.session, self.spans, self.random = executor, kernel, session, spans, random
        self.entities = [Entity(handle, Seen()) for handle in executor.handles]
        session.entities += [each for each in self.entities if each.handle.kind not in WITHOUT_MESSAGES]
        self.seen, self.start = SeenLoop(), start
        self.prepares, self.looks = random.choice((0, 0, 2, 4)), random.choice((0, 0, 2, 4))
        self.is_shared = False
        self.members = [self]

    def steps(self, members):
        """The thread, in which some executors spin one after the other."""
        loop, kernel = self.model.loop, self.kernel
        yield Until(self.start)
        invoked, woken = kernel.now, None
        while True:
            begin = kernel.now
            for one in members:
                one.members = members
                yield from one._spin_some(one.model.loop.timeout)
                if (place := one.model.place) is not None and place.sleep:
                    yield Until(self.spans.draw(kernel.now + place.sleep - place.sleep_early, kernel.now + place.sleep))
            if self.model.place is None and loop.kind is LoopKind.SLEEPING and loop.sleep:
                least = kernel.now + loop.sleep - loop.sleep_early
                end = self.spans.draw(least, kernel.now + loop.sleep)
                if woken is not None and loop.pace > loop.sleep - loop.sleep_early:
                    end = max(end, woken + loop.pace)
                woken = end
                yield Until(end)
            elif loop.kind is LoopKind.PERIODIC:
                left = invoked + loop.period - kernel.now
                if left > 0:
                    yield Until(kernel.now + left // MS * MS)
                invoked += loop.period
            if kernel.now == begin:
                yield Until(self._next())
                for one in members:
                    one.ended = None

    def _next(self):
        """When anything changes next, for a loop that takes no time."""
        entities = [each for one in self.members for each in one.entities]
        times = [each.due for each in entities if (each.is_timer or each.is_item) and each.due > self.kernel.now]
        if self.kernel.next_event is not None:
            times.append(self.kernel.next_event)
        return max(min(times, default=self.kernel.now + MS), self.kernel.now + 1)

    def _spin_some(self, timeout):
        total = self.spans.draw(*self.spans.spins[self.model.name])
        before = total * self.prepares // 4
        if before:
            yield Run(before)
        begin, is_unread = self.kernel.now, bool(self.session.unread)
        yield from self._wait(timeout)
        end = self.kernel.now
        if self.ended is not None:
            self.seen.loops.append(end - self.ended)
        self.ended = end
        after = total - before
        middle = after * self.looks // 4
        if middle:
            yield Run(middle)
        for entity in self.entities:
            entity.look(self.kernel.now)
        if after - middle:
            yield Run(after - middle)
        called = False
        if self._is_triggered():
            called = yield from self._serve()
        self.seen.rounds.append(self.kernel.now - end)
        # After what was read, the next wait can take time.
        if not called and begin == end and not is_unread:
            yield from self._skip(total)

    ended = None

    def _skip(self, total):
        """Rounds of a bare loop that find nothing, at once."""
        loop, kernel = self.model.loop, self.kernel
        if (
            self.is_shared
            or len(self.members) > 1
            or not total
            or (loop.kind is LoopKind.SLEEPING and loop.sleep)
            or self.session.unread
        ):
            return
        if loop.kind is LoopKind.PERIODIC or any(each.handle.always for each in self.entities):
            return
        if any(each.flag is not None or (each.is_timer and each.due <= kernel.now) for each in self.entities):
            return
        rounds = (self._next() - kernel.now) // total
        if rounds > 1:
            yield Run(rounds * total)
            self.ended = None

    def _wait(self, timeout):
        waiting, kernel, session = self.model.waiting, self.kernel, self.session
        listens = any(each.handle.kind not in WITHOUT_MESSAGES for each in self.entities)
        dues = [each.due - kernel.now for each in self.entities if each.is_timer]
        timeout = max(0, min([timeout, *dues]))
        if waiting.resolution:
            timeout = timeout // waiting.resolution * waiting.resolution
        sends_only = bool(self.entities) and all(each.is_item for each in self.entities)
        if not listens and (waiting.polls_without_messages or sends_only):
            return
        if self.is_shared:
            yield Lock(session.mutex)
        # What was stored while others had the session ends the wait, too.
        end = kernel.now + (0 if self._is_woken() else timeout)
        while not (session.unread and listens) and kernel.now < end:
            while session.unread:
                # For others; data does not end a wait for none (micro-ROS/rmw_microxrcedds#305).
                session.store()
            yield Listen(session.signal, end)
            if self._is_woken():
                break
        most = waiting.messages_per_wait
        for _ in range(len(session.unread) if most is None or not listens else min(most, len(session.unread))):
            session.store()
        if self.is_shared:
            yield from self._unlock()

    def _is_woken(self):
        """Whether something that is there already ends the wait; without a session, others can store it at any time."""
        waiting, entities = self.model.waiting, self.entities
        return (waiting.stored_data_ends_wait and any(each.stored for each in entities)) or (
            waiting.guard_conditions_end_wait and any(each.flag is not None for each in entities)
        )

    def _unlock(self):
        """Release the session; a thread that has waited for it and has a higher priority goes first, whatever else takes no time."""
        self.kernel.unlock(self.session.mutex)
        yield Run(0)

    def _is_triggered(self):
        ready = {each.handle.name for each in self.entities if each.ready}
        match self.model.trigger.kind:
            case TriggerKind.ANY:
                return bool(ready)
            case TriggerKind.ALL:
                return len(ready) == len(self.entities)
            case TriggerKind.ALWAYS:
                return True
            case _:
                return any(names <= ready for names in self.model.trigger.sets)

    def _serve(self):
        chosen = [each for each in self.entities if each.ready or each.handle.always]
        taken = {}
        if self.model.takes_first:
            for entity in chosen:
                if not (entity.is_timer or entity.is_item):
                    taken[id(entity)] = yield from self._take(entity)
        for entity in chosen:
            if id(entity) in taken:
                release = taken[id(entity)]
            else:
                release = yield from self._take(entity)
            start = self.kernel.now
            if entity.is_timer or entity.is_item:
                entity.advance(start)
            yield from self._call(entity)
            if release is not None:
                entity.seen.lateness.append(start - release)
                entity.seen.responses.append(self.kernel.now - release)
        return bool(chosen)

    def _take(self, entity):
        """A message leaves its place when its take begins; when in that time is not specified."""
        release = entity.take(self.kernel.now)
        if entity.handle.take:
            yield Run(self.spans.draw(*self.spans.costs[entity.handle.take]))
        return release

    def _call(self, entity):
        cost = self.spans.draw(*self.spans.costs[entity.handle.runnable])
        for publication in entity.handle.publications:
            part = self.spans.draw(0, cost)
            if part:
                yield Run(part)
            cost -= part
            yield from self._publish(publication)
        if cost:
            yield Run(cost)

    def _publish(self, publication):
        """A reliable one runs the session until the acknowledgement is there, and stores what arrives meanwhile."""
        least, most = self.spans.sending.get(publication.transmission, (0, publication.timeout if publication.waits else 0))
        end = self.kernel.now
        if self.is_shared:
            yield Lock(self.session.mutex)
            end = self.kernel.now
        end += self.spans.draw(least, most)
        if publication.waits:
            while self.kernel.now < end:
                while self.session.unread:
                    self.session.store()
                yield Listen(self.session.signal, end)
            while self.session.unread:
                self.session.store()
        else:
            yield Until(end)
        if self.is_shared:
            yield from self._unlock()


def play(executors, spans, horizon, *, random=None, preempting=(), priorities=None, delays=None, start=None):
    """The executors after some time.

    Parameters
    ----------
    spans : of execution times and of sending
    preempting : (priority, period, offset, least and greatest execution time) of other tasks on the core
    priorities : of executors; the first one has the highest unless told
    delays : greatest further delay of messages on their way, by handle
    start : of the first spin; somewhere in a sleep unless told
    """
    random, kernel, sessions = random or Random(0), Kernel(), {}
    played, threads = [], {}
    for number, executor in enumerate(executors):
        session = sessions.setdefault(executor.session, Session(executor.waiting.slots))
        first = _start(executor.loop, random) if start is None else start
        one = Played(executor, kernel, session, spans, random, first)
        sharing = {_thread(each) for each in executors if each.session == executor.session}
        one.is_shared = len(sharing) > 1 and executor.session is not None
        played.append(one)
        members = threads.setdefault(_thread(executor), [])
        members.append(one)
        if len(members) == 1:
            kernel.start(one.steps(members), (priorities or {}).get(executor.name, 5 - number))
        for entity in one.entities:
            _release(entity, one, session, kernel, horizon, random, (delays or {}).get(entity.handle.name, 0))
    for priority, period, offset, *cost in preempting:
        for release in range(offset, horizon, period):
            # Jobs are in the order of their activations, also among those of other tasks.
            kernel.at(release, lambda priority=priority, cost=cost: kernel.start(iter((Run(spans.draw(*cost)),)), priority))
    kernel.play(horizon)
    for one in played:
        for entity in one.entities:
            entity.seen.waiting += [kernel.now - each for each in entity.stored]
            entity.seen.waiting += [
                kernel.now - each
                for each in (entity.flag, None if entity.is_item else entity.due)
                if each is not None and each < kernel.now
            ]
    for session in sessions.values():
        for entity, release in session.unread:
            entity.seen.waiting.append(kernel.now - release)
    return played


def _thread(executor):
    return executor.name if executor.place is None else executor.place.thread


def _start(loop, random):
    """Somewhere in the sleep of a loop that runs already."""
    return random.choice((0, random.randint(0, loop.sleep // 10**6) * 10**6))


def _release(entity, played, session, kernel, horizon, random, delay):
    """Put what makes a handle ready into the future."""
    handle = entity.handle
    if entity.is_item:
        entity.due = 0
        return
    interval, jitter = handle.interval, handle.jitter + delay
    phase = handle.phase
    if phase is None:
        phase = random.choice((0, random.randint(0, interval // 10**6) * 10**6))
    if entity.is_timer:
        entity.due = phase
        while entity.due < played.start:
            entity.due += interval
        return
    shape = random.choice(("none", "alternating", "random", "burst"))
    nominal, number, arrived, arrivals = phase, 0, 0, []
    rest = 0 if handle.is_periodic else random.choice((0, interval))
    while nominal < horizon:
        late = {
            "none": 0,
            "alternating": jitter * (number % 2),
            "burst": max(0, jitter - number * interval) if nominal < jitter else 0,
        }
        arrived = max(arrived, nominal + late.get(shape, random.randint(0, jitter // 10**6) * 10**6))
        arrivals.append(arrived)
        nominal += interval + (random.randint(0, rest // 10**6) * 10**6 if rest else 0)
        number += 1
    for time in arrivals:
        kernel.at(time, lambda time=time: _arrive(entity, played, session, kernel, time))


def _arrive(entity, played, session, kernel, time):
    if entity.is_guard:
        entity.trigger(time)
        if played.model.waiting.guard_conditions_end_wait:
            kernel.wake(session.signal)
    else:
        session.unread.append((entity, time))
        kernel.wake(session.signal)
