"""A core with fixed priorities, first come first served within one; its threads are generators that ask for what they need next."""

import heapq
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Run:
    """Execute for some time."""

    work: int


@dataclass(frozen=True, slots=True)
class Until:
    """Sleep to a point in time."""

    end: int


@dataclass(frozen=True, slots=True)
class Lock:
    """Wait for a mutex, and take it."""

    mutex: "Mutex"


@dataclass(frozen=True, slots=True)
class Listen:
    """Wait for a signal, at most to a point in time."""

    signal: "Signal"
    end: int


class Mutex:
    """Given to the thread with the highest priority that waits for it as soon as it is released."""

    def __init__(self):
        self.owner, self.waiting = None, []


class Signal:
    def __init__(self):
        self.waiting = []


@dataclass
class Thread:
    steps: object
    priority: int
    work: int = 0
    is_ready: bool = True
    since: int = 0
    turn: int = 0


@dataclass
class Kernel:
    """Plays threads and events of the surroundings in the order of time."""

    now: int = 0
    threads: list = field(default_factory=list)
    _events: list = field(default_factory=list)
    _number: int = 0

    def start(self, steps, priority):
        self.threads.append(Thread(steps, priority))
        self._wake(self.threads[-1])

    def at(self, time, what):
        """Do something at a point in time."""
        self._number += 1
        heapq.heappush(self._events, (time, self._number, what))

    @property
    def next_event(self):
        return self._events[0][0] if self._events else None

    def unlock(self, mutex):
        mutex.owner = None
        if mutex.waiting:
            first = max(mutex.waiting, key=lambda thread: thread.priority)
            mutex.waiting.remove(first)
            mutex.owner = first
            self._wake(first)

    def wake(self, signal):
        for thread in signal.waiting:
            self._wake(thread)
        signal.waiting.clear()

    def play(self, horizon):
        while self.now < horizon:
            while self._events and self._events[0][0] <= self.now:
                heapq.heappop(self._events)[2]()
            thread = max(
                (each for each in self.threads if each.is_ready), key=lambda each: (each.priority, -each.since), default=None
            )
            if thread is None:
                if not self._events:
                    return
                self.now = self._events[0][0]
            elif thread.work:
                end = self.now + thread.work
                if self._events:
                    end = min(end, self._events[0][0])
                thread.work -= end - self.now
                self.now = end
            else:
                self._ask(thread)

    def _ask(self, thread):
        thread.turn += 1
        match next(thread.steps, None):
            case None:
                self.threads.remove(thread)
            case Run(work):
                thread.work = work
            case Until(end):
                if end > self.now:
                    self._block(thread, end)
            case Listen(signal, end):
                if end > self.now:
                    signal.waiting.append(thread)
                    self._block(thread, end, signal)
            case Lock(mutex):
                if mutex.owner is None:
                    mutex.owner = thread
                else:
                    mutex.waiting.append(thread)
                    thread.is_ready = False

    def _block(self, thread, end, signal=None):
        thread.is_ready, turn = False, thread.turn

        def over():
            if thread.turn == turn and not thread.is_ready:
                if signal is not None and thread in signal.waiting:
                    signal.waiting.remove(thread)
                self._wake(thread)

        self.at(end, over)

    def _wake(self, thread):
        self._number += 1
        thread.is_ready, thread.since = True, self._number
