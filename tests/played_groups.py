"""A multi-threaded executor tick by tick, each thread on a core of its own; written from the sources of rclcpp (`executor.cpp`,
`multi_threaded_executor.cpp`), it knows nothing of the product.

At one instant, first callbacks end, then messages arrive and timers become due, and then threads decide. A poll looks at what is
ready and of no busy group. Up to iron it forgets what was ready before and of a busy group; from jazzy on, timers stay.
"""

from collections import defaultdict, deque


class Executor:
    """Callbacks are those of `played_host`; a group is a name, or "" for a reentrant one."""

    def __init__(self, callbacks, groups, threads, keeps_timers, due):
        self.callbacks, self.groups, self.keeps_timers, self.due = callbacks, groups, keeps_timers, due
        self.queues = {each.name: deque() for each in callbacks}
        self.running = [None] * threads
        self.ready = []

    def busy(self):
        return {self.groups[job[0].name] for job in self.running if job} - {""}

    def poll(self, now, random):
        busy, before = self.busy(), self.ready
        mixed = sorted(random.sample(self.callbacks, len(self.callbacks)), key=lambda each: not each.period)
        self.ready = []
        for each in mixed:
            if self.groups[each.name] in busy:
                is_ready = self.keeps_timers and bool(each.period) and each in before
            else:
                is_ready = self.due[each.name] <= now if each.period else bool(self.queues[each.name])
            if is_ready:
                self.ready.append(each)

    def next(self, now, random):
        """What a thread takes, with its release and that of its root; None if there is nothing."""
        for attempt in range(2):
            busy = self.busy()
            for each in self.ready:
                if self.groups[each.name] not in busy:
                    self.ready.remove(each)
                    return self.taken(each, now)
            if not attempt:
                self.poll(now, random)
        return None

    def taken(self, each, now):
        if not each.period:
            return each, *self.queues[each.name].popleft()
        release = self.due[each.name]
        while self.due[each.name] <= now:
            self.due[each.name] += each.period
        return each, release, release

    def arrive(self, each, now, root):
        queue = self.queues[each.name]
        if len(queue) == each.depth:
            queue.popleft()
        queue.append((now, root))


def play(executor, sources, horizon, random):
    """The longest times of each callback, from its own release and from that of the head of its chain."""
    own, whole, coming = defaultdict(int), defaultdict(int), defaultdict(list)
    for topic, times in sources.items():
        for time in times:
            coming[time].append((topic, None))
    for now in range(horizon):
        # Nothing changes between completions, arrivals, and times at which timers are due.
        has_changed = now in coming or now in executor.due.values()
        for number, job in enumerate(executor.running):
            if job and job[3] == now:
                has_changed = True
                each, release, root, _ = job
                own[each.name] = max(own[each.name], now - release)
                whole[each.name] = max(whole[each.name], now - root)
                for topic, latency in each.sends.items():
                    coming[now + latency].append((topic, root))
                executor.running[number] = None
        for topic, root in coming.pop(now, ()):
            for each in executor.callbacks:
                if each.topic == topic:
                    executor.arrive(each, now, now if root is None else root)
        for number, job in enumerate(executor.running):
            if has_changed and job is None and (taken := executor.next(now, random)) is not None:
                worst, best = taken[0].worst, taken[0].best
                executor.running[number] = (*taken, now + random.choice([worst, random.randint(best, worst)]))
    return own, whole
