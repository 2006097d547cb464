"""What is known about a limited quantity: the ends between which its maximum or minimum is proved to be, or observed values."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.timing.basics.quantities import jitter_of
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class Ends:
    """Between which ends the maximum or minimum of a quantity lies, in all behaviours of the system.

    Attributes
    ----------
    lower, upper : equal if the value is exact; None if that end is unknown or infinite
    is_infinite : whether it is certain that a maximum exceeds every limit, as in an overload
    """

    lower: Time | None = None
    upper: Time | None = None
    is_infinite: bool = False

    @classmethod
    def exactly(cls, value: Time) -> Ends:
        """Those of a value that is known."""
        return cls(value, value)

    def safe(self, is_upper: bool) -> Time | None:
        """The end that is decisive for a limit to be met."""
        return self.upper if is_upper else self.lower


@dataclass(frozen=True, slots=True)
class ProvedLoss:
    """Activations or messages that are lost for certain, or may be."""

    reason: str
    is_certain: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessEvidence:
    """What is proved of a process.

    Attributes
    ----------
    response : of the worst-case response time
    overload : why response times certainly grow without a limit; None if that is not certain
    loss : of activations; None if none can be lost
    gap : why it is unknown how the process behaves; None if it is known
    is_served : whether it has callbacks, all of which are called in time
    """

    response: Ends = Ends()
    overload: str | None = None
    loss: ProvedLoss | None = None
    gap: str | None = None
    is_served: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class ObservedValues:
    """The observed values of something.

    Attributes
    ----------
    low, high : the smallest and the greatest one; None if there is none, for the `reason`
    pending : what has already passed of one that had not ended at the end of the observation
    is_complete : whether all values are known
    are_least : whether the real values can be greater than these, for the `reason`
    reason : why values are missing
    violation : why the limit is not kept, whatever the values are
    low_at, high_at, violated_at : when the smallest and the greatest one and the violation were first observed, in picoseconds;
        None if that is not one time
    """

    low: Fraction | None = None
    high: Fraction | None = None
    pending: Fraction = Fraction(0)
    is_complete: bool = True
    are_least: bool = False
    reason: str = ""
    violation: str = ""
    low_at: Fraction | None = None
    high_at: Fraction | None = None
    violated_at: Fraction | None = None

    @classmethod
    def only(cls, value: Fraction | int) -> ObservedValues:
        """Those of something that has one value in a run."""
        return cls(low=Fraction(value), high=Fraction(value))

    def jitter(self, period: Time | None = None) -> ObservedValues:
        """The jitter of the values, as `timing.jitter.jitter_of` defines it; values that can be greater have none."""
        if self.low is None or self.high is None or self.are_least:
            return replace(self, low=None, high=None, pending=Fraction(0))
        found, late = jitter_of(self.low, self.high, period), [at for at in (self.low_at, self.high_at) if at is not None]
        # A value that is pending exceeds the least one already.
        pending = max(Fraction(0), self.pending - self.low)
        return replace(self, low=found, high=found, pending=pending, high_at=max(late, default=None))


@dataclass(frozen=True, slots=True, kw_only=True)
class ObservedProcess:
    """What was observed of a process.

    Attributes
    ----------
    response : of the response times
    lost_activations : beyond the activation limit
    """

    response: ObservedValues
    lost_activations: int = 0
