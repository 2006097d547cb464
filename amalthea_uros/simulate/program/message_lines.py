"""Lines that delay messages and keep their order, and alarms, in memory."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.network import Span
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.sampling.streams import durations
from amalthea_uros.simulate.sampling.words import RandomSource

#: Assumptions.
_DELAYS = "times in the agent, in switches and in drivers are uniform between their limits, and keep the order of messages"
_MEANS = "where only the mean of a time in the agent is known, every message takes it"


@dataclass(slots=True)
class Lines:
    """The records of lines and alarms."""

    resources: Resources
    _alarms: list[int] = field(default_factory=list)

    @property
    def alarms(self) -> list[int]:
        """Planned occurrences: at one instant, messages come before timers of the host are due."""
        words = self.resources.image.words
        return sorted(self._alarms, key=lambda alarm: words[alarm + layout.ALARM_KIND] == layout.HOST_TIMERS)

    def delay(self, place: str, *spans: Span) -> int:
        """The stream of a delay that consists of several.

        Instead of a maximum that is unknown, the minimum counts; nothing that depends on it is observed: see `MessageRecords.obstacle`.
        """
        taken = [span.simulated for span in spans]
        least = sum(span.least for span in taken)
        most = sum(span.least if span.most is None else span.most for span in taken)
        if most > least:
            self.resources.context.notes.assume(_DELAYS)
        if any(span != stated for span, stated in zip(taken, spans, strict=True)):
            self.resources.context.notes.assume(_MEANS)
        source = RandomSource(self.resources.options.seed, f"delay {place}")
        times = Boundaries(lower=least, upper=most)
        return self.resources.stream(durations(times, Fraction(self.resources.units), self.resources.options.mode, source))

    def line_of(self, transmission: int, delay: int, leads_to: int) -> int:
        """A line of messages with a stream of delays; as what it sends those that begin there."""
        line = self.resources.image.record(
            layout.LINE_SIZE, {layout.DELAY: delay, layout.LEADS_TO: leads_to, layout.CREATES: transmission}
        )
        self.resources.image.put(line, {layout.ITS_ALARM: self.alarm(layout.DELAY_LINE, line)})
        return line

    def alarm(self, kind: int, owner: int, at: int = layout.NEVER) -> int:
        """The record of something that occurs at planned times."""
        fields = {layout.ALARM_AT: at, layout.ALARM_KIND: kind, layout.ALARM_OF: owner}
        self._alarms.append(self.resources.image.record(layout.ALARM_SIZE, fields))
        return self._alarms[-1]
