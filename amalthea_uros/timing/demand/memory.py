"""The latency of accesses to labels and channels, by their memory and the access path.

Each element of a path takes cycles of its own clock, and a connection those of the element before it; without a path, the access
element gives the cycles of the core. The latency of the memory is added (help of APP4MC on the hardware model). With a data rate, the
size of the data is divided by it. Whether that is instead of the cycles or besides them, where both are stated, is not standardised: an
access takes at least the shorter of the two, and at most both. Accesses do not wait for those of other cores. If something of this is
not stated, the demand of the process is unknown.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import ceil, floor

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import AccessKind
from amalthea_uros.perf.distributions import Distribution, highest, lowest
from amalthea_uros.perf.hardware import Access, Cache, Connection, Interconnect, Latency, Memory
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.timing.basics.time_base import Ticks
from amalthea_uros.timing.demand.means import mean
from amalthea_uros.timing.demand.multiframe import DemandFrame
from amalthea_uros.units import SECOND, Frequency, time_of_ticks

#: (minimum, mean, maximum), in picoseconds.
Times = tuple[Fraction, Fraction, Fraction]
#: The same in the time base of a core; minimum and maximum are usually whole numbers, with which it is quicker to calculate.
_TimesInBase = tuple[int | Fraction, Fraction, int | Fraction]
ZERO: Times = (Fraction(0), Fraction(0), Fraction(0))


@dataclass(slots=True)
class MemoryAccess:
    """The latencies of accesses, each computed once.

    Attributes
    ----------
    frequency : the clock of a core
    """

    system: System
    notes: AnalysisNotes
    frequency: Callable[[str], Frequency | None]
    _found: dict[tuple[str, str, AccessKind, int | None, int, int], _TimesInBase] = field(default_factory=dict)

    def frame(
        self, core: str, label: str, kind: AccessKind, count: tuple[int, Fraction, int], time_base: Fraction
    ) -> DemandFrame:
        """The demand of some accesses.

        Parameters
        ----------
        label : or a channel, whose elements are accessed one by one
        count : minimum, mean and maximum number of accesses
        time_base : time units per picosecond

        Raises
        ------
        UnknownError : the latency is unknown.
        """
        memory = self.system.memories.get(self.system.memory_of.get(label) or "")
        if memory is None:
            item = self.system.labels.get(label) or self.system.channels.get(label)
            raise self._unknown(f"{label!r} is not mapped to a memory", item)
        # Thousands of labels are in a few memories.
        key = (core, memory.name, kind, self._size(label), time_base.numerator, time_base.denominator)
        if key not in self._found:
            self._found[key] = self._times(core, memory, kind, self._size(label), time_base)
        minimum, average, maximum = self._found[key]
        return DemandFrame(
            worst=Ticks(ceil(maximum * count[2])), best=Ticks(floor(minimum * count[0])), average=average * count[1]
        )

    def _times(self, core: str, memory: Memory, kind: AccessKind, size: int | None, time_base: Fraction) -> _TimesInBase:
        """The latency of one access, in the time base."""
        found = self._latency(core, memory, kind, size)
        minimum, average, maximum = (time * time_base for time in found)
        return (_whole(minimum), average, _whole(maximum))

    def _latency(self, core: str, memory: Memory, kind: AccessKind, size: int | None) -> Times:
        accesses = [access for access in self.system.cores[core].accesses if access.memory == memory.name]
        if not accesses:
            raise self._unknown(f"the core {core!r} has no access element for the memory {memory.name!r}", memory)
        paths = [self._path(core, access, kind, size) for access in accesses]
        # Any of several paths can be used.
        path = (min(times[0] for times in paths), max(paths, key=lambda times: times[2])[1], max(times[2] for times in paths))
        return _sum(path, _cycles(memory.latency, self._clock(memory.clock), memory.name))

    def _unknown(self, reason: str, item: Named | None) -> UnknownError:
        """An error, which is also a finding about an object."""
        self.notes.warning("ANA008", reason, item)
        return UnknownError(reason)

    def _size(self, name: str) -> int | None:
        """The size of a label, or of an element of a channel."""
        label, channel = self.system.labels.get(name), self.system.channels.get(name)
        return label.size if label is not None else channel.element_size if channel is not None else None

    def _path(self, core: str, access: Access, kind: AccessKind, size: int | None) -> Times:
        frequency = self.frequency(core)
        if not access.path:
            return _latency(access.latency, kind, frequency, size, core)
        total = ZERO
        before = frequency
        for name in access.path:
            match self.system.modules.get(name):
                case Cache(latency=latency, clock=clock):
                    before = self._clock(clock)
                    total = _sum(total, _cycles(latency, before, name))
                case Interconnect(latency=between, clock=clock):
                    before = self._clock(clock)
                    total = _sum(total, _latency(between, kind, before, size, name))
                case Connection(latency=between):
                    total = _sum(total, _latency(between, kind, before, size, name))
        return total

    def _clock(self, name: str | None) -> Frequency | None:
        return self.system.frequency_of(name)


def _latency(latency: Latency, kind: AccessKind, frequency: Frequency | None, size: int | None, where: str) -> Times:
    cycles = latency.read if kind is AccessKind.READ else latency.write
    if not latency.rate:
        return _cycles(cycles, frequency, where)
    if size is None or size < 0:
        raise UnknownError(f"the size of data that pass {where!r} is {'unknown' if size is None else 'negative'}")
    if latency.rate < 0:
        raise UnknownError(f"the data rate of {where!r} is negative")
    time = Fraction(size * SECOND, latency.rate)
    if cycles is None:
        return (time, time, time)
    minimum, average, maximum = _cycles(cycles, frequency, where)
    return (min(minimum, time), average + time, maximum + time)


def _cycles(cycles: Distribution[int] | None, frequency: Frequency | None, where: str) -> Times:
    if cycles is None:
        return ZERO
    if frequency is None:
        raise UnknownError(f"the clock frequency of {where!r} is unknown")
    minimum, maximum = lowest(cycles), highest(cycles)
    if minimum is None or maximum is None:
        raise UnknownError(f"the memory latency of {where!r} has no bounds")
    if not 0 <= minimum <= maximum:
        raise UnknownError(f"the memory latency of {where!r} is negative, or its bounds are in the wrong order")
    one = time_of_ticks(1, frequency)
    return (minimum * one, mean(cycles) * one, maximum * one)


def _whole(time: Fraction) -> int | Fraction:
    """The same number, as an integer if it is one."""
    return time.numerator if time.denominator == 1 else time


def _sum(first: Times, second: Times) -> Times:
    return (first[0] + second[0], first[1] + second[1], first[2] + second[2])
