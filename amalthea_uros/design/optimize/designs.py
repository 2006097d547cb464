"""From the values in which a design differs to its system, and how it is built otherwise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.design.changes.apply import Difference, apply, describe
from amalthea_uros.design.changes.change import Change, compact
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.optimize.rules import Rule, period_of
from amalthea_uros.design.optimize.space import Candidate, PriorityOrder
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import counters, first_time, nominal_period
from amalthea_uros.units import Time, time_text


@dataclass(frozen=True, slots=True, kw_only=True)
class RebuiltStructure:
    """A system that is built otherwise, for example with a callback in a task of its own.

    Attributes
    ----------
    changes : what a description of it says otherwise
    rules, rate_monotonic : as of `Designs`
    """

    changes: tuple[Change, ...]
    system: System
    rules: tuple[Rule, ...] = ()
    rate_monotonic: tuple[PriorityOrder, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Designs:
    """The systems of designs.

    Attributes
    ----------
    present : the system and settings as they are
    rules : for all designs
    rate_monotonic : tasks whose priorities follow their periods; tasks of the same period keep their order
    stated : what can only be changed in a description -> its present value
    structures : changes of what is stated there -> what is built then, or why it is impossible
    """

    present: Configuration
    rules: tuple[Rule, ...] = ()
    rate_monotonic: tuple[PriorityOrder, ...] = ()
    stated: Mapping[str, str] = field(default_factory=dict)
    structures: Mapping[Candidate, RebuiltStructure | str] = field(default_factory=dict)

    def divided(self, candidate: Candidate) -> tuple[Candidate, Candidate]:
        """What of a design is changed in the description, and what in the system that is built of it."""
        own = tuple(change for change in candidate if change.target in self.stated)
        return own, tuple(change for change in candidate if change.target not in self.stated)

    def built(self, own: Candidate) -> Designs:
        """The designs of the system that a changed description describes; InvalidArgumentError if it is impossible."""
        if not own:
            return self
        found = self.structures[own]
        if isinstance(found, str):
            raise InvalidArgumentError(found)
        configuration = self.present._replace(system=found.system)
        return Designs(present=configuration, rules=found.rules, rate_monotonic=found.rate_monotonic)

    def described_changes(self, own: Candidate) -> tuple[Change, ...]:
        """All that a description states otherwise."""
        found = self.structures[own] if own else ()
        return found.changes if isinstance(found, RebuiltStructure) else ()

    def changes(self, candidate: Candidate) -> tuple[Change, ...]:
        """All changes that make the system of a design: those of the candidate, and what follows from them."""
        own, values = self.divided(candidate)
        return (*self.described_changes(own), *self.built(own).value_changes(values))

    def value_changes(self, candidate: Candidate) -> tuple[Change, ...]:
        """All changes of the system that is present."""
        followed = (*candidate, *self._rate_monotonic(candidate))
        return (*followed, *self._kept_messages(apply(*self.present, followed).system))

    def configure(self, candidate: Candidate) -> Configuration:
        """The system and settings of a design; InvalidArgumentError if it is impossible."""
        own, values = self.divided(candidate)
        built = self.built(own)
        return apply(*built.present, built.value_changes(values))

    def describe(self, candidate: Candidate) -> tuple[Difference, ...]:
        """The changed values of a design, before and after."""
        own, values = self.divided(candidate)
        stated = (Difference(each.object, each.key, self.stated[each.target], each.value) for each in own)
        return (*stated, *describe(*self.built(own).present, values))

    def broken_rule(self, candidate: Candidate, system: System) -> str:
        """The rule that the system of a design breaks; "" if there is none."""
        rules = self.built(self.divided(candidate)[0]).rules
        return next((rule.text for rule in rules if rule.is_broken(system)), "")

    def _rate_monotonic(self, candidate: Candidate) -> Iterator[Change]:
        if not self.rate_monotonic:
            return
        old, new = self.present.system, apply(*self.present, candidate).system
        present = {each.task: str(each.priority) for each in old.mapping.tasks}
        for order in self.rate_monotonic:
            tasks = sorted(order.tasks, key=lambda task: period_of(task, new) or 0)
            yield from (change for change in order.changes(tasks) if present[change.object] != change.value)

    def _kept_messages(self, changed: System) -> Iterator[Change]:
        """What comes from outside comes as often as before, and first at the same time, whatever the periods that take it are."""
        old, new = _messages(self.present.system), _messages(changed)
        for source, (interval, first) in old.items():
            if new[source][0] != interval and interval is not None:
                yield Change(source, "arrival_period", compact(time_text(interval)))
                if first is not None and source not in self.present.settings.phases:
                    yield Change(source, "phase", compact(time_text(first)))


def _messages(system: System) -> dict[str, tuple[Time | None, Time | None]]:
    """How often, and when first, what comes from outside is taken; None: unknown."""
    found: dict[str, tuple[Time | None, Time | None]] = {}
    for process, counter in counters(system):
        if counter.source and counter.source not in found:
            first = first_time(process, counter, system) if counter.is_phase_known and counter.arrivals is None else None
            found[counter.source] = nominal_period(system.processes[process], counter, system), first
    return found
