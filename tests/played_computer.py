"""Whole hosts tick by tick: executors of all kinds in threads of all policies on several cores.

It reads descriptions, and knows by itself what rclcpp (`executor.cpp`, `multi_threaded_executor.cpp`,
`static_single_threaded_executor.cpp`, `events_executor.cpp`) and Linux (sched(7), a constant bandwidth server for each reservation)
do. At one instant, first callbacks end, then messages arrive and timers become due, and then threads decide. What is not specified
is random: phases, orders, latencies and execution times.
"""

from collections import defaultdict, deque
from dataclasses import dataclass

EARLY = ("foxy", "galactic", "humble", "iron")
USUAL = ("timer", "subscription", "service", "client")
LONGEST = 5


class Executor:
    """What is queued and due; the subclasses take it in the order of their kind."""

    def __init__(self, section, release, random, phases):
        self.callbacks, self.release, self.random = section.callbacks, release, random
        self.queues = {each.name: deque() for each in section.callbacks}
        self.due = {each.name: phases(each) for each in section.callbacks if each.period}
        self.ready, self.busy, self.lost = [], [], set()
        self.order = USUAL

    def arrive(self, callback, now, trails):
        """Queue a message, in place of the oldest one of a full queue."""
        queue = self.queues[callback.name]
        if len(queue) == callback.depth:
            queue.popleft()
            self.lost.add(callback.name)
        queue.append((now, trails))

    def expire(self, now):
        """What timers do when they are due: nothing before a poll."""

    def is_ready(self, callback, now):
        return self.due[callback.name] <= now if callback.period else bool(self.queues[callback.name])

    def has_work(self, now):
        return bool(self.ready) or any(self.is_ready(each, now) for each in self.callbacks)

    def call(self, callback, now):
        """The callback with its release, and where its message comes from; a timer skips periods that have passed."""
        if not callback.period:
            return callback, *self.queues[callback.name].popleft()
        release = self.due[callback.name]
        while self.due[callback.name] <= now:
            self.due[callback.name] += callback.period
        if self.due[callback.name] > release + callback.period:
            self.lost.add(callback.name)
        return callback, release, []

    def in_order(self):
        """By kind; then as registered in foxy, by groups in any order up to iron, and in any order from jazzy on."""
        groups = list(dict.fromkeys(each.group for each in self.callbacks))
        mixed = list(self.callbacks)
        if self.release == "foxy":
            groups = [None]
        elif self.release in EARLY:
            self.random.shuffle(groups)
        else:
            groups = [None]
            self.random.shuffle(mixed)
        grouped = [each for group in groups for each in mixed if group in (None, each.group)]
        return sorted(grouped, key=lambda each: self.order.index(each.kind))

    def take(self, now):
        if not self.ready:
            self.ready = [each for each in self.in_order() if self.is_ready(each, now)]
        return self.call(self.ready.pop(0), now) if self.ready else None


class Static(Executor):
    """Subscriptions before timers; from jazzy on, one callback for each wait, and clients before services."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        last = ("service", "client") if self.release in EARLY else ("client", "service")
        self.order = ("subscription", "timer", *last)

    def take(self, now):
        taken = super().take(now)
        if self.release not in EARLY:
            self.ready = []
        return taken


class EventsExecutor(Executor):
    """A queue of events; one whose message was overwritten calls nothing."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.events = deque()

    def arrive(self, callback, now, trails):
        super().arrive(callback, now, trails)
        self.events.append((callback, now, []))

    def expire(self, now):
        for each in self.callbacks:
            while each.period and self.due[each.name] <= now:
                self.events.append((each, self.due[each.name], []))
                self.due[each.name] += each.period

    def has_work(self, now):
        return bool(self.events)

    def take(self, now):
        while self.events:
            callback, release, trails = self.events.popleft()
            if callback.period:
                return callback, release, trails
            if self.queues[callback.name]:
                return callback, *self.queues[callback.name].popleft()
        return None


class Threads(Executor):
    """Several threads share a ready set; a poll forgets what belongs to busy groups, but from jazzy on not the timers."""

    def poll(self, now):
        before, self.ready = self.ready, []
        for each in self.in_order():
            if not each.is_reentrant and each.group in self.busy:
                is_ready = self.release not in EARLY and bool(each.period) and each in before
            else:
                is_ready = self.is_ready(each, now)
            if is_ready:
                self.ready.append(each)

    def take(self, now):
        for attempt in range(2):
            for each in self.ready:
                if each.is_reentrant or each.group not in self.busy:
                    self.ready.remove(each)
                    self.busy.append(each.group)
                    return self.call(each, now)
            if not attempt:
                self.poll(now)
        return None


KINDS = {
    "single-threaded": Executor,
    "static-single-threaded": Static,
    "multi-threaded": Threads,
    "events": EventsExecutor,
}


@dataclass(eq=False)
class Worker:
    """A thread of an executor, with the budget and the deadline of its reservation."""

    executor: Executor
    thread: object
    cores: list
    job: tuple | None = None
    left: int = 0
    budget: int = 0
    deadline: int = 0
    is_awake: bool = False

    def replenish(self, now):
        """Wake up with a new deadline if the rest of the budget is too much for the old one; go on at the deadline if none is left."""
        wants = self.job is not None or self.executor.has_work(now)
        if wants and not self.is_awake:
            is_too_much = self.budget * self.thread.period > (self.deadline - now) * self.thread.budget
            if self.deadline <= now or is_too_much:
                self.budget, self.deadline = self.thread.budget, now + self.thread.period
        elif wants and not self.budget and now >= self.deadline:
            self.budget, self.deadline = self.thread.budget, self.deadline + self.thread.period
        self.is_awake = wants


class Play:
    """One run of a host; `own` has the longest times from the release of a callback, `whole` those from that of the head of a path."""

    def __init__(self, host, sources, random):
        self.random, self.topics = random, {each.name: each for each in host.topics}
        self.own, self.whole, self.coming = defaultdict(int), defaultdict(int), defaultdict(list)
        self.last_arrival, self.unread, self.workers = defaultdict(int), {}, []
        self.readers = defaultdict(list)
        self.subscribers = defaultdict(list)
        self.cores = [(computer.name, core) for computer in host.computers for core in range(computer.cores)]
        for section in host.executors:
            executor = KINDS[section.kind](section, str(host.release), random, lambda each: random.randrange(each.period))
            for each in section.callbacks:
                for variable in each.reads:
                    self.readers[variable].append(each.name)
                self.subscribers[each.topic].append((executor, each))
            count = section.threads if section.kind == "multi-threaded" else 1
            allowed = [core for core in self.cores if core[0] == section.computer]
            cores = [core for core in allowed if core[1] in section.thread.cores] or allowed
            self.workers += [Worker(executor, section.thread, cores) for _ in range(count)]
        self.running = dict.fromkeys(self.cores)
        for topic, times in sources.items():
            for time in times:
                self.coming[time] += [(*subscriber, []) for subscriber in self.subscribers[topic]]

    @property
    def lost(self):
        return {name for worker in self.workers for name in worker.executor.lost}

    def until(self, horizon):
        for now in range(horizon):
            for executor, callback, trails in self.coming.pop(now, ()):
                executor.arrive(callback, now, trails)
            for worker in self.workers:
                worker.executor.expire(now)
            for worker in self.workers:
                if worker.thread.policy == "deadline":
                    worker.replenish(now)
            placed = [self.choose(core, now) for core in self.cores]
            for worker in placed:
                if worker is not None:
                    self.advance(worker, now + 1)
        return self

    def choose(self, core, now):
        """Let the first thread that has something to do run on a core."""
        others = {worker for other, worker in self.running.items() if other < core}
        before = self.running[core]
        workers = [each for each in self.workers if core in each.cores and each not in others]
        for worker in sorted(workers, key=lambda each: (*rank(each), each.job is None, each is not before)):
            if worker.thread.policy == "deadline" and not worker.budget:
                continue
            if worker.job is not None or self.begin(worker, now):
                self.running[core] = worker
                return worker
        self.running[core] = None
        return None

    def begin(self, worker, now):
        taken = worker.executor.take(now)
        if taken is None:
            return False
        callback, release, trails = taken
        for variable in callback.reads:
            trails = [*trails, *self.unread.pop((variable, callback.name), ())]
        worker.job = (callback, release, trails)
        least, most = callback.execution.least, callback.execution.most
        worker.left = self.random.choice([most, self.random.randint(least, most)])
        return True

    def advance(self, worker, end):
        worker.left -= 1
        worker.budget -= worker.thread.policy == "deadline"
        if worker.left:
            return
        callback, release, before = worker.job
        worker.job = None
        if callback.group in worker.executor.busy:
            worker.executor.busy.remove(callback.group)
        trails = [
            *((*trail, (callback.name, release)) for trail in before if len(trail) < LONGEST),
            ((callback.name, release),),
        ]
        self.own[callback.name] = max(self.own[callback.name], end - release)
        for trail in trails:
            names = tuple(name for name, _ in trail)
            self.whole[names] = max(self.whole[names], end - trail[0][1])
        for variable in callback.writes:
            for reader in self.readers[variable]:
                self.unread.setdefault((variable, reader), []).extend(trails)
        for topic in callback.publishes:
            latency = self.topics[topic].latency
            for executor, subscriber in self.subscribers[topic]:
                arrival = end + self.random.randint(latency.least, latency.most)
                arrival = max(arrival, self.last_arrival[topic, subscriber.name])
                self.last_arrival[topic, subscriber.name] = arrival
                self.coming[arrival].append((executor, subscriber, trails))


def rank(worker):
    """SCHED_DEADLINE by deadlines, before SCHED_FIFO by priorities, before SCHED_OTHER."""
    thread = worker.thread
    if thread.policy == "deadline":
        return 0, worker.deadline
    return (1, -thread.priority) if thread.policy == "fifo" else (2, 0)
