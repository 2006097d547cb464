"""Plays a whole application from the host to the host, step by step.

Messages pass the agent, the wire, the driver, the interrupt, the executor with its callbacks, and the way back. It follows rclc,
rmw_microxrcedds and Micro-XRCE-DDS-Client, knows nothing of the analysis, and takes a description instead of a system.
Times are in picoseconds. What is not known is chosen by a random generator.
"""

import heapq
from collections import defaultdict, deque
from dataclasses import dataclass, field
from itertools import count

from executor_kernel import Kernel, Listen, Run, Signal, Until

US, MS, S = 10**6, 10**9, 10**12
ACKNOWLEDGEMENT = 13
#: Client heartbeats follow a silence of 100 ms, those of the agent come every 200 ms while something is not acknowledged.
SILENCE, AGENT_HEARTBEAT = 100 * MS, 200 * MS
GIVES_UP = 1000 * MS
NEVER = 10**18


@dataclass
class Seen:
    """What was observed: times by the names of ways, handles and wires' messages, lateness of timers, and what lost something."""

    ways: dict = field(default_factory=lambda: defaultdict(list))
    responses: dict = field(default_factory=lambda: defaultdict(list))
    lateness: dict = field(default_factory=lambda: defaultdict(list))
    sent: dict = field(default_factory=lambda: defaultdict(list))
    lost: set = field(default_factory=set)


class Wire:
    """Frames one after the other: of the lowest identifier first, and in the order of queueing."""

    def __init__(self, kernel):
        self.kernel, self.queue, self.busy, self.number = kernel, [], False, count()

    def send(self, rank, time, done):
        heapq.heappush(self.queue, (rank, next(self.number), time, done))
        self._next()

    def _next(self):
        if self.busy or not self.queue:
            return
        _, _, time, done = heapq.heappop(self.queue)
        self.busy = True

        def end():
            self.busy = False
            done()
            self._next()

        self.kernel.at(self.kernel.now + time(), end)


class Player:
    """An application.

    Parameters
    ----------
    plan : the description as a mapping, with times in picoseconds
    chance : a random generator
    """

    def __init__(self, plan, chance):
        self.plan, self.chance, self.kernel, self.seen, self.number = plan, chance, Kernel(), Seen(), count()
        self.tx = Wire(self.kernel)
        self.rx = Wire(self.kernel) if plan["wire"] in ("serial", "udp", "tcp") else self.tx
        self.inbox, self.labels, self.waits_for = deque(), defaultdict(lambda: -1), None
        self.arrived, self.written = Signal(), Signal()
        self.handles = plan["handles"]
        self.pool = {each["name"]: deque() for each in self.handles}
        self.due = {each["name"]: each["phase"] for each in self.handles if each["kind"] == "timer"}
        self.receives = any(each["kind"] == "subscription" for each in self.handles)
        self.published, self.pending_outputs = {}, defaultdict(list)
        self.tick_phase = chance.randrange(plan["tick"]) if plan["tick"] else 0

    def play(self, until):
        plan = self.plan
        for handle in self.handles:
            if handle["kind"] == "subscription":
                self._publish_on_host(handle, handle["phase"], 0)
        for task in plan["tasks"]:
            self._activate(task, 0)
        for frame in plan["foreign"]:
            self._foreign(frame, self.chance.randrange(frame["period"]))
        if any(each.get("reliable") for each in self.handles):
            self._agent_heartbeat(self.chance.randrange(AGENT_HEARTBEAT))
        self.kernel.start(self._executor(), plan["priority"])
        self.kernel.play(until)
        return self.seen

    # The host, the agent and the wire

    def _between(self, span):
        low, high = span
        return self.chance.choice((low, high, self.chance.randint(low, high)))

    def _publish_on_host(self, handle, time, number):
        def publish():
            key = (handle["name"], number)
            self.published[key] = self.kernel.now
            self.kernel.at(self.kernel.now + self._between(self.plan["to_controller"]), lambda: self._enter(handle, key))
            pause = self.chance.choice((1, 1, 1, self.chance.uniform(1, 3)))
            self._publish_on_host(handle, time + int(handle["period"] * pause), number + 1)

        self.kernel.at(time, publish)

    def _enter(self, handle, key):
        length = 12 + handle["size"]
        queued = self.kernel.now

        def done():
            self.seen.sent[f"{handle['topic']}_topic_to_{handle['name']}"].append(self.kernel.now - queued)
            self._received(("data", handle, key), length)

        self._send(self.rx, length, done, incoming=True)

    def _send(self, wire, length, done, incoming):
        parts = self._frames(length)
        for index, time in enumerate(parts):
            last = index == len(parts) - 1
            wire.send(2, self._written(time, index) if not incoming else (lambda time=time: time), done if last else _nothing)

    def _frames(self, length):
        """The times of the chunks of a message."""
        plan, kind = self.plan, self.plan["wire"]
        if kind in ("udp", "tcp"):
            content = length + (28 if kind == "udp" else 42)
            return [(max(content + 18, 64) + 20) * 8 * S // plan["rate"]]
        if kind == "custom":
            return [self._between(plan["transfer"])]
        if kind == "can_fd":
            return [self._between(plan["frame_times"][length])]
        size = length + 7 + self._between((0, length + 6))
        chunks = [min(42, size - start) for start in range(0, size, 42)]
        if kind == "usb_cdc":
            bits = [(chunk + 13) * 8 for chunk in chunks]
            return [(each + self._between((0, each // 6))) * S // plan["rate"] for each in bits]
        return [chunk * 10 * S // plan["rate"] for chunk in chunks]

    def _written(self, time, index):
        """How long a chunk keeps the driver and the wire, which is known when it begins."""
        tick = self.plan["tick"]
        if not tick:
            return lambda: time

        def at_a_tick():
            end = self.kernel.now + time
            late = -(end - self.tick_phase) % tick
            return time + late

        return at_a_tick

    def _foreign(self, frame, time):
        def send():
            self.tx.send(0, lambda: self._between(frame["time"]), _nothing)
            self._foreign(frame, time + frame["period"])

        self.kernel.at(time, send)

    def _received(self, item, length):
        """A message has arrived: it passes the driver, the interrupt and a task of the middleware."""
        waited = self.chance.randrange(self.plan["tick"] + 1) if self.plan["tick"] else 0
        self.kernel.at(self.kernel.now + self._between(self.plan["link"]) + waited, lambda: self._interrupt(item))

    def _interrupt(self, item):
        stages = [(cost, priority) for cost, priority in self.plan["stages"]]

        def passing():
            for cost, _ in stages[:1]:
                yield Run(self._between(cost))
            self._handled(item, stages[1:])

        if stages:
            self.kernel.start(passing(), stages[0][1])
        else:
            self._handled(item, [])

    def _handled(self, item, stages):
        if stages:
            ((cost, priority),) = stages

            def handling():
                yield Run(self._between(cost))
                self._handled(item, [])

            self.kernel.start(handling(), priority)
            return
        self.inbox.append((self.kernel.now, item))
        self.kernel.wake(self.arrived)

    def _agent_heartbeat(self, time):
        def beat():
            if self.chance.random() < 0.5:
                self._send(self.rx, ACKNOWLEDGEMENT, lambda: self._received(("heartbeat", None, None), ACKNOWLEDGEMENT), True)
            self._agent_heartbeat(time + AGENT_HEARTBEAT)

        self.kernel.at(time, beat)

    # The client

    def _write(self, length, done):
        """Write a message; a driver that blocks returns when it is on the wire."""
        if not self.plan["blocks"]:
            self._send(self.tx, length, done, incoming=False)
            return
        written = []

        def end():
            done()
            written.append(True)
            self.kernel.wake(self.written)

        self._send(self.tx, length, end, incoming=False)
        while not written:
            yield Listen(self.written, NEVER)

    def _read(self):
        """Read a message if one is there; whether it was data."""
        time, (kind, handle, key) = self.inbox.popleft()
        if kind == "acknowledgement":
            if key == self.waits_for:
                self.waits_for = None
            return False
        if kind == "heartbeat" or handle.get("reliable"):
            yield from self._write(ACKNOWLEDGEMENT, _nothing)
        if kind == "heartbeat":
            return False
        pool, kept = self.pool[handle["name"]], sum(map(len, self.pool.values()))
        if len(pool) >= handle["depth"]:
            self.seen.lost.add(handle["name"])
            pool.popleft()
        elif kept >= self.plan["slots"]:
            self.seen.lost.add(handle["name"])
            return True
        pool.append((time, key))
        return True

    def _wait(self):
        now = self.kernel.now
        timeout = self.plan["timeout"] if self.receives else 0
        pending = [max(0, due - now) for due in self.due.values()] if self.receives else []
        end = now + min([timeout, *pending]) // MS * MS
        while True:
            while self.inbox:
                if (yield from self._read()):
                    return
            if self.kernel.now >= end:
                return
            yield Listen(self.arrived, end)

    # The executor

    def _executor(self):
        plan, invocation = self.plan, self.kernel.now
        yield Until(plan["begin"])
        invocation = self.kernel.now
        while True:
            yield from self._round()
            if plan["loop"] == "spin_period":
                invocation += plan["period"]
                left = (invocation - self.kernel.now) // MS * MS
                if left > 0:
                    yield Until(self.kernel.now + left)
            elif plan["sleep"]:
                yield Until(self.kernel.now + plan["sleep"])

    def _round(self):
        overhead = self.plan["overhead"]
        before = self._between((0, overhead))
        yield Run(before)
        yield from self._wait()
        ready = [each for each in self.handles if self._is_ready(each)]
        yield Run(overhead - before)
        taken = {}
        if self.plan["semantics"] == "LET":
            # A timer has nothing to be taken: it is called, and its next time set, when its callback is (`rclc_take_new_data`).
            for handle in ready:
                if handle["kind"] != "timer":
                    taken[handle["name"]] = yield from self._take(handle)
        for handle in ready:
            found = taken[handle["name"]] if handle["name"] in taken else (yield from self._take(handle))
            yield from self._call(handle, *found)

    def _is_ready(self, handle):
        return self.due[handle["name"]] <= self.kernel.now if handle["kind"] == "timer" else bool(self.pool[handle["name"]])

    def _take(self, handle):
        name = handle["name"]
        if handle["kind"] == "timer":
            due = self.due[name]
            self.seen.lateness[name].append(self.kernel.now - due)
            # What is due again meanwhile is left out: the grid is kept.
            skipped = (self.kernel.now - due) // handle["period"]
            if skipped:
                self.seen.lost.add(name)
            self.due[name] = due + (skipped + 1) * handle["period"]
            return due, None
        yield Run(self.plan["take"])
        return self.pool[name].popleft()

    def _call(self, handle, release, key):
        name = handle["name"]
        value = (key[1], self.published[key]) if key else self.labels["command"]
        yield Run(self._between(handle["cost"]))
        if handle.get("writes"):
            self.labels[handle["writes"]] = value
            self._output(f"{name}-{handle['writes']}", value, key)
        for topic, size, reliable in handle.get("publishes", ()):
            yield from self._publish(name, topic, size, reliable, value, key)
        self.seen.responses[name].append(self.kernel.now - release)

    def _publish(self, callback, topic, size, reliable, value, key):
        length = 8 + -(-(4 + size) // 4) * 4
        begin, number = self.kernel.now, next(self.number)

        def on_wire():
            self.seen.sent[f"{topic}_topic_from_{callback}"].append(self.kernel.now - begin)
            late = self._between(self.plan["link"])
            at_agent = self.kernel.now + late
            self.kernel.at(
                at_agent + self._between(self.plan["to_host"]), lambda: self._output(f"{callback}-/{topic}", value, key)
            )
            if reliable:
                self.kernel.at(at_agent + self._between(self.plan["acknowledgement"]), lambda: self._acknowledge(number))

        yield from self._write(length, on_wire)
        if not reliable or not self.plan["waits"]:
            return
        self.waits_for, end, silent = number, self.kernel.now + GIVES_UP, self.kernel.now
        while self.waits_for is not None and self.kernel.now < end:
            if self.inbox:
                silent = self.kernel.now
                yield from self._read()
                continue
            if self.kernel.now >= silent + SILENCE:
                silent = self.kernel.now
                yield from self._write(ACKNOWLEDGEMENT, lambda: None)
                continue
            yield Listen(self.arrived, min(end, silent + SILENCE))
        if self.waits_for is not None:
            self.seen.lost.add(topic)
        self.waits_for = None

    def _acknowledge(self, number):
        self._send(
            self.rx, ACKNOWLEDGEMENT, lambda: self._received(("acknowledgement", None, number), ACKNOWLEDGEMENT), incoming=True
        )

    # Tasks and outputs

    def _activate(self, task, time):
        def job():
            value = self.labels[task["reads"]] if task.get("reads") else None
            yield Run(self._between(task["cost"]) - 1)
            if task.get("reads"):
                self._output(f"{task['name']}", value, None)

        def activate():
            self.kernel.start(_started(job), task["priority"])
            self._activate(task, time + task["period"])

        self.kernel.at(time, activate)

    def _output(self, end, value, key):
        """An output based on a message; the ways of that message and of earlier ones that have not ended end here."""
        if value == -1:
            return
        self.pending_outputs[end].append((value, self.kernel.now))


def _started(job):
    """A job that reads when it begins to execute, which is when its first bit of execution is over at the latest."""
    yield Run(1)
    yield from job()


def _nothing():
    pass
