"""Verdicts: what is known about a quantity compared with its limit.

A proof shows that a limit is met or missed in all behaviours of the system. That a limit was kept in what was observed is no such
proof: the verdict is *observed as kept*, never *met*. That it was missed is one.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from fractions import Fraction
from typing import Any, Self, TypeVar

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.judge.evidence import Ends, ObservedProcess, ObservedValues, ProcessEvidence, ProvedLoss
from amalthea_uros.judge.limits import SystemLimit
from amalthea_uros.judge.margins import margin_of
from amalthea_uros.units import Rounding, Time, number_text, rounded_time_text, time_text


class Verdict(StrEnum):
    """Whether a deadline, requirement or constraint is met; unbounded: an overload makes it impossible."""

    MET = "met"
    MISSED = "missed"
    UNBOUNDED = "unbounded"
    UNKNOWN = "unknown"


class ObservedVerdict(StrEnum):
    """Whether a limit was kept in the run; that it was kept is no proof that it always is."""

    OK = "observed_ok"
    MISSED = "observed_missed"
    NOT_OBSERVED = "not_observed"


class Failure(StrEnum):
    """What is wrong with a process."""

    MISSED = "missed"
    LOST = "lost"
    OVERLOAD = "overload"


N = TypeVar("N", bound=int | Fraction)

FAILURES = (Verdict.MISSED, Verdict.UNBOUNDED)
#: The verdict on several cases, or what is shown first.
WORST_FIRST = (Verdict.UNBOUNDED, Verdict.MISSED, Verdict.UNKNOWN, Verdict.MET, None)
WORST_OBSERVED_FIRST = (ObservedVerdict.MISSED, ObservedVerdict.NOT_OBSERVED, ObservedVerdict.OK, None)


@dataclass(frozen=True, slots=True)
class Judgement:
    """A verdict by proof.

    Attributes
    ----------
    reason : why it is not met, as far as the ends do not show it
    ends : those that can be shown
    spread : minimum and maximum, of which a jitter is the difference
    """

    verdict: Verdict
    reason: str = ""
    failure: Failure | None = None
    ends: Ends = field(default_factory=Ends)
    spread: tuple[Time, Time] | None = None


@dataclass(frozen=True, slots=True)
class ObservedJudgement:
    """A verdict by observation.

    Attributes
    ----------
    value : that is decisive; None if there is none
    reason : why it is missed although the value does not show it, or not observed
    at : when the value, or what is wrong, was first observed, in picoseconds; None if that is not one time
    """

    verdict: ObservedVerdict
    value: Fraction | None = None
    reason: str = ""
    at: Fraction | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ObservedLimit:
    """A limit with its verdict by observation.

    Attributes
    ----------
    name : of the requirement, or of the process with the deadline
    limit, value : of a time, in picoseconds, or of a number; None if it is unknown
    is_time : whether they are times
    reason : why it is missed although the value does not show it, or not observed
    """

    name: str
    object: str
    quantity: str
    is_upper: bool
    limit: Fraction | None
    verdict: ObservedVerdict
    value: Fraction | None = None
    is_time: bool = True
    reason: str = ""

    @classmethod
    def of(cls, limit: SystemLimit, judged: ObservedJudgement, **more: Any) -> Self:
        """The result for a limit that was judged, with `more` of what a kind of results has."""
        return cls(
            name=limit.name,
            object=limit.object,
            quantity=limit.quantity,
            is_upper=limit.is_upper,
            limit=None if limit.limit is None else Fraction(limit.limit),
            verdict=judged.verdict,
            value=judged.value,
            is_time=limit.is_time,
            reason=judged.reason,
            **more,
        )

    @property
    def margin(self) -> Fraction | None:
        """Distance of the value from the limit; negative if the limit is missed."""
        return margin_of(self.value, self.limit, self.is_upper)


# Proofs


def prove(limit: SystemLimit, ends: Ends, reason: str = "") -> Judgement:
    """The verdict on a limit: met or missed only if both ends agree on it.

    Parameters
    ----------
    reason : why the end that would prove it is unknown
    """
    if limit.limit is None:
        return unknown(reason)
    if cause := _contradiction(limit, ends):
        return unknown(cause)
    safe = ends.safe(limit.is_upper)
    other = ends.safe(not limit.is_upper)
    found = decide(None if ends.is_infinite else safe, other, lambda value: _holds(value, limit))
    if found is Verdict.MET:
        return Judgement(found, ends=ends)
    if found is Verdict.MISSED or (limit.is_upper and ends.is_infinite):
        return Judgement(Verdict.MISSED, reason if safe is None else "", ends=ends)
    return Judgement(Verdict.UNKNOWN, (reason if safe is None else "") or _undecided(limit, ends), ends=ends)


def decide(safe: N | None, other: N | None, holds: Callable[[N], bool]) -> Verdict:
    """The verdict by the ends between which a value lies: met or missed only if both agree.

    Parameters
    ----------
    safe : the end that is decisive for the limit to be met: the upper one for an upper limit
    holds : whether a value keeps the limit
    """
    if safe is not None and holds(safe):
        return Verdict.MET
    return Verdict.MISSED if other is not None and not holds(other) else Verdict.UNKNOWN


def prove_kept(is_kept: bool) -> Judgement:
    """The verdict on a limit without a number."""
    return Judgement(Verdict.MET if is_kept else Verdict.MISSED)


def unknown(reason: str) -> Judgement:
    """The verdict on what cannot be evaluated."""
    return Judgement(Verdict.UNKNOWN, reason)


def prove_process(deadline: SystemLimit | None, evidence: ProcessEvidence) -> Judgement | None:
    """The verdict on a process: what is certainly wrong, what is unknown, then its deadline; None without any of these."""
    if evidence.overload is not None:
        return Judgement(Verdict.UNBOUNDED, evidence.overload, Failure.OVERLOAD)
    loss = evidence.loss
    if loss is not None and loss.is_certain:
        return Judgement(Verdict.MISSED, loss.reason, Failure.LOST)
    if evidence.gap is not None:
        return unknown(evidence.gap)
    found = None if deadline is None else prove(deadline, evidence.response)
    if found is not None and found.verdict is Verdict.MISSED:
        return replace(found, failure=Failure.MISSED)
    if loss is not None and (found is None or found.verdict is Verdict.MET):
        return unknown(loss.reason)
    return Judgement(Verdict.MET) if found is None and evidence.is_served else found


def lost_jobs(limit: SystemLimit, pending: Ends) -> ProvedLoss | None:
    """The activations that are lost if more jobs are pending than a task allows; None if that is impossible."""
    found = prove(limit, pending)
    if found.verdict is Verdict.MET:
        return None
    jobs = limit.limit if pending.upper is None else pending.upper
    return ProvedLoss(
        f"{jobs} jobs can be pending, and the activation limit is {limit.limit}", is_certain=found.verdict is Verdict.MISSED
    )


def _holds(value: Time | Fraction, limit: SystemLimit) -> bool:
    assert limit.limit is not None
    return value <= limit.limit if limit.is_upper else value >= limit.limit


def _contradiction(limit: SystemLimit, ends: Ends) -> str:
    """Why no value can be between some ends: nothing follows from an error of this program."""
    lower, upper = ends.lower, ends.upper
    if not limit.is_signed and any(end is not None and end < 0 for end in (lower, upper)):
        return f"its {limit.quantity} was computed as negative, which is impossible"
    if lower is not None and upper is not None and lower > upper:
        return f"its {limit.quantity} was computed as at least {_text(limit, lower)} and at most {_text(limit, upper)}"
    return ""


def _undecided(limit: SystemLimit, ends: Ends) -> str:
    """Why a limit that lies between the ends is neither met nor missed."""
    what = "maximum" if limit.is_upper else "minimum"
    match ends.lower, ends.upper:
        case int(lower), int(upper):
            return f"the {what} is between {_outward(limit, lower, Rounding.DOWN)} and {_outward(limit, upper, Rounding.UP)}"
        case int(lower), None:
            return f"the {what} is at least {_outward(limit, lower, Rounding.DOWN)}, and no upper bound is known"
        case None, int(upper):
            return f"the {what} is at most {_outward(limit, upper, Rounding.UP)}, and no lower bound is known"
    return f"the {what} is unknown"


def _outward(limit: SystemLimit, value: Time, rounding: Rounding) -> str:
    """An end with four digits that is still a bound, and on the same side of the limit."""
    return rounded_time_text(value, rounding, limit.time) if limit.is_time else number_text(value)


def _text(limit: SystemLimit, value: Time) -> str:
    return time_text(value) if limit.is_time else number_text(value)


# Observations


def observe(limit: SystemLimit, values: ObservedValues) -> ObservedJudgement:
    """The verdict on a limit by observed values."""
    if values.violation:
        value = observe(limit, replace(values, violation="")).value
        return ObservedJudgement(ObservedVerdict.MISSED, value, values.violation, values.violated_at)
    if limit.limit is None:
        is_kept = values.high is not None
        return ObservedJudgement(ObservedVerdict.OK) if is_kept else not_observed(values.reason)
    # Without anything pending, it is 0, which is no value of what can be negative.
    if limit.is_upper and values.pending > max(limit.limit, 0):
        if values.high is not None and values.high >= values.pending:
            return ObservedJudgement(ObservedVerdict.MISSED, values.high, at=values.high_at)
        return ObservedJudgement(ObservedVerdict.MISSED, values.pending, "not ended at the end of the run")
    value, at = _extreme(limit, values)
    if value is None:
        return not_observed(values.reason)
    if not _holds(value, limit) and (limit.is_upper or not values.are_least):
        return ObservedJudgement(ObservedVerdict.MISSED, value, at=at)
    if values.is_complete and not values.are_least:
        return ObservedJudgement(ObservedVerdict.OK, value, at=at)
    return ObservedJudgement(ObservedVerdict.NOT_OBSERVED, value, values.reason, at)


def not_observed(reason: str) -> ObservedJudgement:
    """The verdict on what was not observed."""
    return ObservedJudgement(ObservedVerdict.NOT_OBSERVED, reason=reason)


def in_doubt(found: ObservedJudgement, doubt: str) -> ObservedJudgement:
    """The same verdict; if what was observed is no behaviour of the system, not observed for this reason."""
    if not doubt or found.verdict is ObservedVerdict.NOT_OBSERVED:
        return found
    return replace(found, verdict=ObservedVerdict.NOT_OBSERVED, reason=doubt)


def observe_process(deadline: SystemLimit | None, seen: ObservedProcess) -> ObservedJudgement | None:
    """The verdict on the deadline of a process, and on activations that were lost; None if there is neither."""
    if seen.lost_activations:
        return ObservedJudgement(ObservedVerdict.MISSED, reason=f"{counted(seen.lost_activations, 'activation')} lost")
    if deadline is None:
        return None
    found, pending = observe(deadline, seen.response), seen.response.pending
    if deadline.limit is not None and pending > deadline.limit:
        return replace(found, reason=f"a job had not ended {time_text(pending)} after its activation")
    return found


def _extreme(limit: SystemLimit, values: ObservedValues) -> tuple[Fraction | None, Fraction | None]:
    """The value that a limit is about, and when it was observed."""
    return (values.high, values.high_at) if limit.is_upper else (values.low, values.low_at)
