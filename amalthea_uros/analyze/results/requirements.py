"""The verdict on a limit of a requirement or a constraint."""

from __future__ import annotations

from dataclasses import dataclass, field

from amalthea_uros._internal.shown import Shown
from amalthea_uros.judge.limits import SystemLimit
from amalthea_uros.judge.margins import margin_of
from amalthea_uros.judge.verdict import Judgement, Verdict
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class RequirementResult(Shown):
    """The verdict on a requirement or a constraint; the margin is not negative if it is met.

    Attributes
    ----------
    limit : None if it is not a limit of a time
    lower, upper : between these the limited maximum or minimum lies; equal if it is exact, None if that end is unknown
    spread : minimum and maximum, of which a jitter is the difference; None for what is no such jitter, or unknown
    reason : why the verdict is unknown
    stated : the limit in the system
    """

    name: str
    object: str
    quantity: str
    is_upper: bool
    limit: Time | None
    verdict: Verdict
    lower: Time | None = None
    upper: Time | None = None
    spread: tuple[Time, Time] | None = None
    reason: str = ""
    stated: SystemLimit | None = field(default=None, repr=False, compare=False)

    @classmethod
    def of(cls, limit: SystemLimit, found: Judgement) -> RequirementResult:
        """The result for a limit that was judged."""
        return cls(
            name=limit.name,
            object=limit.object,
            quantity=limit.quantity,
            is_upper=limit.is_upper,
            limit=limit.time,
            lower=found.ends.lower,
            upper=found.ends.upper,
            spread=found.spread,
            verdict=found.verdict,
            reason=found.reason,
            stated=limit,
        )

    @property
    def value(self) -> Time | None:
        """The safe end: an upper bound of a maximum, a lower bound of a minimum."""
        return self.upper if self.is_upper else self.lower

    @property
    def margin(self) -> Time | None:
        """Distance of the value from the limit; negative if the limit is missed."""
        return margin_of(self.value, self.limit, self.is_upper)

    @property
    def overloaded_core(self) -> None:
        """That of a process."""
        return
