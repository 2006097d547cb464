"""Plays a whole application whose wire loses messages: which ones is given, and reliable ones are sent again.

It follows Micro-XRCE-DDS-Client `session.c`, `input_reliable_stream.c`, `output_reliable_stream.c`, and the agent's `Processor.cpp` and
`OutputStream.hpp`, with one sequence number per message. It knows nothing of the simulation.
"""

from collections import Counter, defaultdict, deque
from itertools import islice

from executor_kernel import Listen
from whole_player import ACKNOWLEDGEMENT, AGENT_HEARTBEAT, GIVES_UP, MS, NEVER, SILENCE, Player

#: Buffers of the client for each direction, messages that the agent sends without an acknowledgement, and bits of an acknowledgement.
BUFFERS, WINDOW, BITS = 4, 16, 16


class Sender:
    """What was sent and is not acknowledged, by its number."""

    def __init__(self, most):
        self.most, self.next, self.kept = most, 0, {}

    def has_room(self):
        return not self.kept or len(self.kept) < self.most

    def add(self, item):
        self.kept[self.next] = item
        self.next += 1
        return self.next - 1

    def acknowledge(self, up_to):
        for number in [each for each in self.kept if each < up_to]:
            del self.kept[number]


class Receiver:
    """What has arrived, and is kept until everything before it has."""

    def __init__(self, most):
        self.most, self.expected, self.kept, self.known = most, 0, {}, 0

    def accept(self, number, item):
        """The items that can be handed over now."""
        self.known = max(self.known, number + 1)
        if self.expected <= number < self.expected + self.most:
            self.kept[number] = item
        found = []
        while self.expected in self.kept:
            found.append(self.kept.pop(self.expected))
            self.expected += 1
        return found

    def acknowledgement(self):
        """The first number that is missing, and all that are, if any is known to be."""
        numbers = range(self.expected, min(self.known, self.expected + BITS))
        return self.expected, [number for number in numbers if number not in self.kept]


class LossyPlayer(Player):
    """An application.

    Parameters
    ----------
    lost : for messages "to_controller" and "to_agent", in the order of their ends on the wire: whether each is lost
    """

    def __init__(self, plan, chance, lost):
        super().__init__(plan, chance)
        self.lost = {direction: iter(values) for direction, values in lost.items()}
        self.counts = Counter()
        self.up_out, self.up_in = Sender(BUFFERS), Receiver(WINDOW)
        self.down_out, self.down_in = Sender(WINDOW), Receiver(BUFFERS)
        self.held, self.tries, self.next_beat = deque(), 0, NEVER
        self.interval = plan.get("silence", SILENCE)
        self.at_host = defaultdict(list)

    # The wire.

    def _unless_lost(self, direction, arrives):
        def end():
            if next(self.lost[direction], False):
                self.counts[direction] += 1
            else:
                arrives()

        return end

    def _to_controller(self, length, item):
        self._send(self.rx, length, self._unless_lost("to_controller", lambda: self._received(item, length)), incoming=True)

    def _to_agent(self, length, arrives):
        yield from self._write(length, self._unless_lost("to_agent", arrives))

    # The agent.

    def _enter(self, handle, key):
        if not handle["reliable"]:
            self._to_controller(12 + handle["size"], ("data", handle, key))
        elif self.held or not self.down_out.has_room():
            self.held.append((handle, key))
        else:
            self._send_down(self.down_out.add((handle, key)))

    def _send_down(self, number):
        handle, key = self.down_out.kept[number]
        self._to_controller(12 + handle["size"], ("data", handle, (number, key)))

    def _agent_heartbeat(self, _):
        def beat():
            if self.down_out.kept:
                self._to_controller(ACKNOWLEDGEMENT, ("heartbeat", None, self.down_out.next))
            self.kernel.at(self.kernel.now + AGENT_HEARTBEAT, beat)

        self.kernel.at(AGENT_HEARTBEAT, beat)

    def _agent_gets_acknowledgement(self, up_to, missing):
        def process():
            self.down_out.acknowledge(up_to)
            for number in missing:
                if number in self.down_out.kept:
                    wait = self._between(self.plan["to_controller"])
                    # What is acknowledged meanwhile is sent all the same.
                    self.kernel.at(self.kernel.now + wait, self._again(number))
            while self.held and self.down_out.has_room():
                self._send_down(self.down_out.add(self.held.popleft()))

        self.kernel.at(self.kernel.now + self._between(self.plan["link"]), process)

    def _again(self, number):
        handle, key = self.down_out.kept[number]
        return lambda: self._to_controller(12 + handle["size"], ("data", handle, (number, key)))

    def _agent_acknowledges(self):
        content = self.up_in.acknowledgement()
        late = self._between(self.plan["link"]) + self._between(self.plan["acknowledgement"])
        item = ("acknowledgement", None, content)
        self.kernel.at(self.kernel.now + late, lambda: self._to_controller(ACKNOWLEDGEMENT, item))

    def _agent_gets(self, number, topic):
        now = self.kernel.now
        for each in self.up_in.accept(number, topic):
            self.at_host[each].append(now + self._between(self.plan["link"]) + self._between(self.plan["to_host"]))
        self._agent_acknowledges()

    def _agent_gets_heartbeat(self, up_to):
        self.up_in.known = max(self.up_in.known, up_to)
        self._agent_acknowledges()

    # The client.

    def _listen(self, poll):
        """Read one message; False if none has come in time."""
        while True:
            stamp, silence = self.kernel.now, poll
            if self.up_out.kept:
                if self.tries and stamp >= self.next_beat:
                    up_to = self.up_out.next
                    yield from self._to_agent(ACKNOWLEDGEMENT, lambda up_to=up_to: self._agent_gets_heartbeat(up_to))
                self.tries, self.next_beat, silence = 1, stamp + self.interval, min(self.interval, poll)
            end = self.kernel.now + silence
            while not self.inbox and self.kernel.now < end:
                yield Listen(self.arrived, end)
            if self.inbox:
                yield from self._read()
                return True
            poll -= silence
            if poll <= 0:
                return False

    def _read(self):
        time, (kind, handle, content) = self.inbox.popleft()
        if kind == "acknowledgement":
            up_to, missing = content
            self.up_out.acknowledge(up_to)
            self.tries = 0
            if missing:
                for number, (length, topic) in list(self.up_out.kept.items()):
                    yield from self._to_agent(length, lambda n=number, topic=topic: self._agent_gets(n, topic))
            return
        if kind == "heartbeat":
            self.down_in.known = max(self.down_in.known, content)
        elif handle["reliable"]:
            number, key = content
            for each, one in self.down_in.accept(number, (handle, key)):
                self._store(each, time, one)
        else:
            self._store(handle, time, content)
            return
        reply = self.down_in.acknowledgement()
        yield from self._to_agent(ACKNOWLEDGEMENT, lambda: self._agent_gets_acknowledgement(*reply))

    def _store(self, handle, time, key):
        self.has_data = True
        pool, kept = self.pool[handle["name"]], sum(map(len, self.pool.values()))
        if len(pool) >= handle["depth"]:
            pool.popleft()
        elif kept >= self.plan["slots"]:
            return
        pool.append((time, key))

    def _wait(self):
        now = self.kernel.now
        end = now + min([self.plan["timeout"], *(max(0, due - now) for due in self.due.values())]) // MS * MS
        self.has_data = False
        while not self.has_data and (yield from self._listen(max(0, end - self.kernel.now))):
            pass

    def _publish(self, callback, topic, size, reliable, value, key):
        length = 8 + -(-(4 + size) // 4) * 4
        if not reliable:
            late = self._between(self.plan["link"]) + self._between(self.plan["to_host"])
            yield from self._to_agent(length, lambda: self.at_host[topic].append(self.kernel.now + late))
            return
        if not self.up_out.has_room():
            self.counts["refused"] += 1
            return
        number = self.up_out.add((length, topic))
        yield from self._to_agent(length, lambda: self._agent_gets(number, topic))
        end = self.kernel.now + GIVES_UP
        while self.plan["waits"] and self.up_out.kept:
            if not (yield from self._listen(max(0, end - self.kernel.now))):
                self.counts["timeouts"] += 1
                return


def losses(chance, share):
    """Whether each of very many messages is lost."""
    return list(islice(iter(lambda: chance.random() < share, None), 20_000))
