"""Drives the kernel: gives it occurrences and random values, and takes rows and events away."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from time import thread_time
from typing import TypeAlias, cast

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.limits import WAITING_NUMBERS
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.simulate.kernel import layout, machine_code
from amalthea_uros.simulate.kernel.layout import Memory
from amalthea_uros.simulate.kernel.loop import run_kernel
from amalthea_uros.simulate.program.build import KernelProgram

#: Takes rows.
RowConsumer: TypeAlias = "Callable[[Numbers], None]"

#: Rows that are kept before they are taken away; machine code makes many of them in the time in which they are taken away.
_ROWS, _ROWS_OF_MACHINE_CODE = 4096, 65_536
#: An operation can record some events at once, an END several observations: so much place is left.
_MARGIN = 4096
#: Values of all streams together, and of one stream.
_VALUES, _LEAST_VALUES, _MOST_VALUES = 2**20, 32, 4096
#: Records of messages to begin with.
_MESSAGES = 64
#: Of messages at a time if some can be lost: with each answer about a gap, more are sent again, so that they can multiply without end;
#: and of those that wait in an events executor, whose queue grows without end in an overload.
MOST_MESSAGES = 2**13
#: Occurrences that are prepared at a time, about.
_OCCURRENCES = 8192


@dataclass(slots=True)
class KernelDriver:
    """Runs a program.

    Attributes
    ----------
    until : end of the run, in time units
    traced : the part of the run of which events are recorded
    is_compiled : whether the kernel is machine code by now
    endless : the record of the process of which a job continues forever without taking time, at which the run has ended; 0: none
    multiplied : number of messages at which the run has ended because those that are sent again multiply; 0: it has not
    has_no_place : whether the run has ended because no more activations that wait can be kept
    """

    program: KernelProgram
    until: int
    jobs: RowConsumer
    observations: RowConsumer
    events: RowConsumer
    traced: tuple[int, int] = (0, 0)
    memory: Memory = field(init=False)
    is_compiled: bool = field(init=False, default=False)
    endless: int = field(init=False, default=0)
    multiplied: int = field(init=False, default=0)
    has_no_place: bool = field(init=False, default=False)
    _thread: ThreadPoolExecutor | None = None
    _handed: deque[Future[None]] = field(default_factory=deque)
    _regions: dict[int, int] = field(default_factory=dict)
    _values: int = 0
    _pools: dict[int, int] = field(default_factory=dict)
    _arrivals: int = 0
    _messages: int = _MESSAGES
    _places_for_arrivals: int = 2 * _OCCURRENCES

    def __post_init__(self) -> None:
        self.memory = words = list(self.program.memory)
        self._place_rows(_ROWS)
        streams = len(self.program.streams)
        self._values = min(max(_VALUES // max(1, streams), _LEAST_VALUES), _MOST_VALUES)
        for record in self.program.stream_records:
            self._pools[record] = words[record + layout.STREAM_AT] = words[record + layout.STREAM_END] = len(words)
            words += [0] * self._values
        self._arrivals = len(words)
        words += [0] * (self._places_for_arrivals * layout.ARRIVAL_SIZE)

    def _place_rows(self, count: int) -> None:
        """Have places for a number of rows of each kind."""
        # Without a trace there are no events; one place, so that the kernel does not find that there is none left.
        places = [size * count if first != layout.EVENTS or self.traced[1] > 0 else 1 for first, _, size in _ROW_KINDS]
        place = self._append(sum(places) + _MARGIN * sum(size for _, _, size in _ROW_KINDS))
        for (first, end, size), length in zip(_ROW_KINDS, places, strict=True):
            self._regions[first] = self.memory[first] = place
            self.memory[end] = place + length
            place += length + size * _MARGIN

    @property
    def has_ended_early(self) -> bool:
        """Whether nothing can be simulated any more."""
        return self.endless != 0 or self.multiplied != 0 or self.has_no_place

    def run(self) -> None:
        """Run to the end, or until nothing can be simulated any more."""
        began = thread_time()
        try:
            self._run_to_end(began)
        finally:
            self._await_taker()
            if not self.is_compiled:
                effort = machine_code.effort()
                effort.spent += thread_time() - began
                effort.report(is_used=False)

    def _run_to_end(self, began: float) -> None:
        time, window = 0, max(1, self.until // 1024)
        self._consider_machine_code(0, 0)
        edges = sorted({edge for edge in (*self.traced, self.until) if 0 < edge <= self.until})
        for edge in edges:
            while time < edge and not self.has_ended_early:
                self.memory[layout.IS_TRACED] = int(self.traced[0] <= time < self.traced[1])
                time = self._reach(time, min(edge, time + window))
                count = self._prepare(time)
                self._run_window(time)
                if not self.is_compiled and not self.has_ended_early:
                    self._consider_machine_code(thread_time() - began, (self.until - time) / time)
                if 2 * count < _OCCURRENCES:
                    window *= 2
                elif count > 2 * _OCCURRENCES:
                    window = max(1, window // 2)
        self._take_rows()

    def _run_window(self, until: int) -> None:
        kernel = machine_code.compiled() if self.is_compiled else run_kernel
        self.memory[layout.UNTIL] = until
        while (code := kernel(self.memory)) != layout.WINDOW:
            if code == layout.STREAM_EMPTY:
                self._refill(int(self.memory[layout.CAUSE]))
            elif code == layout.ROWS_FULL:
                self._take_rows()
            elif code == layout.QUEUE_FULL:
                if self._waiting_numbers() > WAITING_NUMBERS // 2:
                    self.has_no_place = True
                    return
                self._grow_queues()
            elif code == layout.NO_MESSAGES:
                can_multiply = self.program.lossy or self.program.host_handles
                if can_multiply and self._messages >= MOST_MESSAGES:
                    self.multiplied = self._messages
                    return
                self._add_messages()
            elif code == layout.ENDLESS:
                # What was observed up to here counts.
                self.endless = int(self.memory[layout.CAUSE])
                return

    def _consider_machine_code(self, seconds: float, times_left: float) -> None:
        """Go on with machine code, which gives the same results, if what is left takes long enough.

        Parameters
        ----------
        seconds, times_left : of processor time that the run has taken so far, and how many times as much is left
        """
        if machine_code.is_worth_it(seconds, seconds * times_left):
            machine_code.effort().report(is_used=True, left=seconds * times_left)
            self._take_rows()
            self.memory = cast(Memory, np.array(self.memory, np.int64))
            self.is_compiled = True
            self._place_rows(_ROWS_OF_MACHINE_CODE)
            self._thread = ThreadPoolExecutor(max_workers=1)

    # What the kernel gets.

    def _reach(self, start: int, until: int) -> int:
        """The end of a window that has not many more occurrences than are prepared at a time, however dense they are."""
        for _, occurrences in self.program.arrivals:
            until = occurrences.reach(start, until, 2 * _OCCURRENCES)
        return until

    def _prepare(self, until: int) -> int:
        """Put the occurrences up to a time into memory, in order; the result is their number."""
        found = [(record, occurrences.until(until)) for record, occurrences in self.program.arrivals]
        times = np.concatenate([np.empty(0, np.int64), *(times for _, times in found)])
        stimuli = np.repeat([record for record, _ in found] or [0], [len(times) for _, times in found] or [0])
        order = np.argsort(times, kind="stable")
        if len(times) > self._places_for_arrivals:
            self._places_for_arrivals = 2 * len(times)
            self._arrivals = self._append(self._places_for_arrivals * layout.ARRIVAL_SIZE)
        rows = np.column_stack((times[order], stimuli[order])).ravel()
        self._write(self._arrivals, rows)
        self.memory[layout.ARRIVAL] = self._arrivals
        self.memory[layout.ARRIVALS_END] = self._arrivals + len(rows)
        return len(times)

    def _refill(self, stream: int) -> None:
        """Put new values into a stream that has none left."""
        values = self.program.streams[self.memory[stream + layout.STREAM_NUMBER]].take(self._values)
        self._write(self._pools[stream], values)
        self.memory[stream + layout.STREAM_AT] = self._pools[stream]
        self.memory[stream + layout.STREAM_END] = self._pools[stream] + len(values)

    def _write(self, place: int, values: Numbers) -> None:
        if self.is_compiled:
            self.memory[place : place + len(values)] = values
        else:
            self.memory[place : place + len(values)] = values.tolist()

    def _append(self, size: int) -> int:
        """More memory at the end; where it begins."""
        place = len(self.memory)
        if self.is_compiled:
            # Zeros take no memory before they are used.
            grown = np.zeros(place + size, np.int64)
            grown[:place] = self.memory
            self.memory = cast(Memory, grown)
        else:
            self.memory += [0] * size
        return place

    def _waiting_numbers(self) -> int:
        """How many numbers the queues of activations take."""
        words = self.memory
        captures = sum(int(words[each + layout.CAPTURES_END] - words[each + layout.CAPTURES]) for each in self.program.queues)
        return int(words[layout.PLACES]) * (captures + layout.QUEUE_CAPTURES * len(self.program.queues))

    def _grow_queues(self) -> None:
        """Give all processes twice as many places for activations."""
        places = int(self.memory[layout.PLACES])
        for record in self.program.queues:
            memory = self.memory
            size = layout.QUEUE_CAPTURES + int(memory[record + layout.CAPTURES_END] - memory[record + layout.CAPTURES])
            first, queue = int(memory[record + layout.FIRST_PLACE]), int(memory[record + layout.QUEUE])
            end = queue + places * size
            # The first pending activation comes first in the new queue.
            rows = np.array([*memory[first:end], *memory[queue:first]], np.int64)
            place = self._append(2 * places * size)
            self._write(place, rows)
            self.memory[record + layout.QUEUE] = self.memory[record + layout.FIRST_PLACE] = place
        self.memory[layout.PLACES] = 2 * places

    def _add_messages(self) -> None:
        """Make as many more records of messages as there are."""
        size = layout.CARRIED + int(self.memory[layout.CARRIED_VALUES])
        first = self._append(size * self._messages)
        for place in range(first, first + size * self._messages, size):
            self.memory[place + layout.NEXT_MESSAGE] = self.memory[layout.FREE_MESSAGES]
            self.memory[layout.FREE_MESSAGES] = place
        self._messages *= 2

    # What the kernel gives.

    def _take_rows(self) -> None:
        for (first, _, size), take in zip(_ROW_KINDS, (self.jobs, self.observations, self.events), strict=True):
            begin, end = self._regions[first], int(self.memory[first])
            if end > begin:
                self._hand_over(take, np.array(self.memory[begin:end], np.int64).reshape(-1, size))
                self.memory[first] = begin

    def _hand_over(self, take: RowConsumer, rows: Numbers) -> None:
        """Have rows taken: at once, or by a thread while machine code continues; only two chunks wait for it at a time."""
        if self._thread is None:
            take(rows)
            return
        self._handed.append(self._thread.submit(take, rows))
        while len(self._handed) > 2:
            self._handed.popleft().result()

    def _await_taker(self) -> None:
        """Everything is taken when this returns."""
        while self._handed:
            self._handed.popleft().result()
        if self._thread is not None:
            self._thread.shutdown()

    def pending(self, process: str) -> int:
        """The number of activations of a process whose jobs have not ended."""
        return int(self.memory[self.program.records[process] + layout.PENDING])


_ROW_KINDS = (
    (layout.JOBS, layout.JOBS_END, layout.JOB_SIZE),
    (layout.OBSERVATIONS, layout.OBSERVATIONS_END, layout.OBSERVATION_SIZE),
    (layout.EVENTS, layout.EVENTS_END, layout.EVENT_SIZE),
)
