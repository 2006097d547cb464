"""From the values in which a design differs to its system, and the rules that it must keep."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from amalthea_uros.changes.apply import apply
from amalthea_uros.changes.change import Change
from amalthea_uros.changes.key import Configuration
from amalthea_uros.optimize.candidate import Candidate
from amalthea_uros.optimize.space import PriorityOrder
from amalthea_uros.perf.system import System
from amalthea_uros.timing.arrivals import nominal_period
from amalthea_uros.timing.phases import counters, first_time
from amalthea_uros.timing.releases import known_releases
from amalthea_uros.units import Time, time_text


@dataclass(frozen=True, slots=True, kw_only=True)
class PeriodRule:
    """The period of a process must not be longer than a time, or than those of other processes.

    Attributes
    ----------
    text : what is wrong with a design that breaks it
    """

    process: str
    longest: Time | None = None
    others: tuple[str, ...] = ()
    text: str

    def is_broken(self, system: System) -> bool:
        """Whether a system breaks it; unknown periods do not."""
        period = _period(self.process, system)
        limits = [self.longest, *(_period(other, system) for other in self.others)]
        return period is not None and any(limit is not None and period > limit for limit in limits)


@dataclass(frozen=True, slots=True, kw_only=True)
class Designs:
    """The systems of designs.

    Attributes
    ----------
    present : the system and settings as they are
    rules : for all designs
    rate_monotonic : tasks whose priorities follow their periods; tasks of the same period keep their order
    """

    present: Configuration
    rules: tuple[PeriodRule, ...] = ()
    rate_monotonic: tuple[PriorityOrder, ...] = ()

    def changes(self, candidate: Candidate) -> tuple[Change, ...]:
        """All changes that make the system of a design: those of the candidate, and what follows from them."""
        followed = (*candidate, *self._rate_monotonic(candidate))
        return (*followed, *self._kept_messages(apply(*self.present, followed).system))

    def configure(self, candidate: Candidate) -> Configuration:
        """The system and settings of a design; InvalidArgumentError if it is impossible."""
        return apply(*self.present, self.changes(candidate))

    def broken_rule(self, system: System) -> str:
        """The rule that a system breaks; "" if there is none."""
        return next((rule.text for rule in self.rules if rule.is_broken(system)), "")

    def _rate_monotonic(self, candidate: Candidate) -> Iterator[Change]:
        if not self.rate_monotonic:
            return
        old, new = self.present.system, apply(*self.present, candidate).system
        present = {each.task: str(each.priority) for each in old.mapping.tasks}
        for order in self.rate_monotonic:
            tasks = sorted(order.tasks, key=lambda task: _period(task, new) or 0)
            yield from (change for change in order.changes(tasks) if present[change.object] != change.value)

    def _kept_messages(self, changed: System) -> Iterator[Change]:
        """What comes from outside comes as often as before, and first at the same time, whatever the periods that take it are."""
        old, new = _messages(self.present.system), _messages(changed)
        for source, (interval, first) in old.items():
            if new[source][0] != interval and interval is not None:
                yield Change(source, "arrival_period", _text(interval))
                if first is not None and source not in self.present.settings.phases:
                    yield Change(source, "phase", _text(first))


def _messages(system: System) -> dict[str, tuple[Time | None, Time | None]]:
    """How often, and when first, what comes from outside is taken; None: unknown."""
    found: dict[str, tuple[Time | None, Time | None]] = {}
    for process, counter in counters(system):
        if counter.source and counter.source not in found:
            first = first_time(process, counter, system) if counter.is_phase_known and counter.arrivals is None else None
            found[counter.source] = nominal_period(system.processes[process], counter, system), first
    return found


def _period(process: str, system: System) -> Time | None:
    found = known_releases(system.processes[process], system)
    return None if found is None else found.period


def _text(time: Time) -> str:
    return time_text(time).replace(" ", "")
