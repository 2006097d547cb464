"""What accesses to labels cost, by the memory of the label and the way there.

With a path, each of its elements takes cycles of its own clock, a connection those of the element before it; without one the access
element tells the cycles of the core. The memory's own latency is added (help of APP4MC on the hardware model). Where there is no
latency but a data rate, the size of the label is divided by the least rate. Accesses are not taken to wait for those of other cores.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction

from amalthea_uros.perf.distributions import Distribution, highest, lowest
from amalthea_uros.perf.hardware import Access, Cache, Connection, Interconnect, Latency
from amalthea_uros.perf.software import AccessKind, Count
from amalthea_uros.perf.system import System
from amalthea_uros.timing.means import mean
from amalthea_uros.timing.multiframe import Frame
from amalthea_uros.timing.notes import Notes, UnknownDemandError
from amalthea_uros.units import SECOND, Frequency, down, time_of_ticks, up

#: (least, mean, most), in picoseconds.
Times = tuple[Fraction, Fraction, Fraction]
NOTHING: Times = (Fraction(0), Fraction(0), Fraction(0))


@dataclass(slots=True)
class MemoryAccess:
    """The cost of accesses, each looked up once.

    Attributes
    ----------
    frequency : the clock of a core
    """

    system: System
    notes: Notes
    frequency: Callable[[str], Frequency | None]
    _known: dict[tuple[str, str, AccessKind], Times] = field(default_factory=dict)

    def frame(self, core: str, label: str, kind: AccessKind, count: tuple[int, Fraction, int], time_base: Fraction) -> Frame:
        """What some accesses cost, in parts of a picosecond.

        Parameters
        ----------
        count : least, mean and most number of accesses
        """
        key = (core, label, kind)
        if key not in self._known:
            self._known[key] = self._times(core, label, kind)
        least, average, most = self._known[key]
        return Frame(
            worst=up(most * count[2] * time_base),
            best=down(least * count[0] * time_base),
            average=average * count[1] * time_base,
        )

    def _times(self, core: str, label: str, kind: AccessKind) -> Times:
        placed = self.system.memory_of.get(label)
        memory = self.system.memories.get(placed or "")
        if memory is None:
            item = self.system.labels.get(label)
            self.notes.warning("ANA008", f"the label {label!r} is in no memory; accesses to it are taken to cost nothing", item)
            return NOTHING
        accesses = [access for access in self.system.cores[core].accesses if access.memory == memory.name]
        if not accesses:
            message = (
                f"there is no way from the core {core!r} to the memory {memory.name!r}; accesses are taken to cost nothing"
            )
            self.notes.warning("ANA008", message, memory)
            return NOTHING
        size = self.system.labels[label].size or 0 if label in self.system.labels else 0
        # Of several ways the slowest one.
        way = max((self._way(core, access, kind, size) for access in accesses), key=lambda times: times[2])
        return _sum(way, _cycles(memory.latency, self._clock(memory.clock)))

    def _way(self, core: str, access: Access, kind: AccessKind, size: int) -> Times:
        frequency = self.frequency(core)
        if not access.path:
            return _latency(access.latency, kind, frequency, size)
        total = NOTHING
        before = frequency
        for name in access.path:
            match self.system.modules.get(name):
                case Cache(latency=latency, clock=clock):
                    before = self._clock(clock)
                    total = _sum(total, _cycles(latency, before))
                case Interconnect(latency=between, clock=clock):
                    before = self._clock(clock)
                    total = _sum(total, _latency(between, kind, before, size))
                case Connection(latency=between):
                    total = _sum(total, _latency(between, kind, before, size))
        return total

    def _clock(self, name: str | None) -> Frequency | None:
        clock = self.system.clocks.get(name or "")
        return clock.frequency if clock is not None else None


def _latency(latency: Latency, kind: AccessKind, frequency: Frequency | None, size: int) -> Times:
    cycles = latency.read if kind is AccessKind.READ else latency.write
    if cycles is None and latency.rate:
        time = Fraction(size * SECOND, latency.rate)
        return (time, time, time)
    return _cycles(cycles, frequency)


def _cycles(cycles: Distribution[int] | None, frequency: Frequency | None) -> Times:
    if cycles is None or frequency is None:
        return NOTHING
    least, most = lowest(cycles), highest(cycles)
    if least is None or most is None:
        raise UnknownDemandError("there is a latency without bounds")
    one = time_of_ticks(1, frequency)
    return (least * one, mean(cycles) * one, most * one)


def _sum(first: Times, second: Times) -> Times:
    return (first[0] + second[0], first[1] + second[1], first[2] + second[2])


def count_of(times: Count | float | None) -> tuple[int, Fraction, int]:
    """Least, mean and most number of accesses that one of the model stands for."""
    if isinstance(times, Count):
        return (times.least, Fraction(times.mean), times.most)
    number = Fraction(1 if times is None else times)
    return (down(number), number, up(number))
