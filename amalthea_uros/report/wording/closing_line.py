"""The verdict on a whole system in one line."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.results.analysis import Judged, SystemSummary
from amalthea_uros.analyze.results.processes import ProcessorResult, RequirementResult
from amalthea_uros.judge.evidence import Ends
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.judge.verdict import Failure
from amalthea_uros.report.wording.cells import directed_limit, limited_text
from amalthea_uros.timing.activation.load import unit_hint
from amalthea_uros.units import Rounding, Time, number_text, rounded, rounded_time_text, time_text

#: Reasons that are only consequences of other reasons end like this.
_CONSEQUENCE = "could not be analysed"


def closing_line(summary: SystemSummary) -> str:
    """Whether everything is met, such as "Schedulable: yes"; otherwise what fails, or how much is unknown and why."""
    unknown = _unknown(summary)
    match summary.schedulable:
        case Schedulable.YES:
            condition = f", {summary.condition}" if summary.condition else ""
            return f"Schedulable: yes{condition}{_tightest(summary)}"
        case Schedulable.NO:
            return "Schedulable: " + "; ".join(filter(None, (f"no: {_failures(summary)}", unknown)))
    return f"Not proved schedulable: {unknown}"


def _tightest(summary: SystemSummary) -> str:
    item = summary.tightest
    if item is None or item.margin is None or item.limit is None:
        return ""
    return f"; tightest: {item.name}, {left_text(item.margin, item.limit, item.is_upper)}"


def left_text(margin: Fraction | int, limit: Fraction | int, is_upper: bool) -> str:
    """How much is left up to a limit: "971 us of 1 ms left", or "5 ms above at least 20 ms"."""
    distance, stated = rounded_time_text(margin, Rounding.DOWN), time_text(limit)
    return f"{distance} of {stated} left" if is_upper else f"{distance} above at least {stated}"


def _failures(summary: SystemSummary) -> str:
    """The first failure with the number of its consequences, and the number of the others."""
    first, *others = summary.causes
    sentence = _core_failure(first.root) if isinstance(first.root, ProcessorResult) else _failure(first.root)
    consequences = f", with {counted(len(first.consequences), 'consequence')}" if first.consequences else ""
    return sentence + consequences + (f"; {counted(len(others), 'other failure')}" if others else "")


def _core_failure(core: ProcessorResult) -> str:
    load = rounded(core.at_least * 100, Rounding.DOWN, limit=100)
    hint = unit_hint(core.at_least, core.frequency)
    text = f"the load of {core.name} is {'at least ' if core.worst is None else ''}{number_text(load)}%"
    return f"{text} ({hint})" if hint else text


def _failure(item: Judged) -> str:
    if isinstance(item, RequirementResult):
        return _violation(item)
    if item.failure is Failure.OVERLOAD:
        return f"{item.name}: {item.reason}"
    if item.failure is Failure.LOST and (item.margin is None or item.margin >= 0):
        return f"{item.name} loses activations: {item.reason}"
    kind = "period" if item.is_implicit else "deadline"
    ends = item.worst_response
    if item.failure is Failure.LOST:
        # With what is lost, the greatest response time need not occur again.
        ends = Ends.exactly(ends.upper or 0)
    text = f"{item.name} responds after {_ends_text(ends, item.deadline)}, {kind} {time_text(item.deadline or 0)}"
    return f"{text}, and loses activations" if item.failure is Failure.LOST else text


def _violation(requirement: RequirementResult) -> str:
    what = limited_text(requirement.quantity, requirement.object)
    if requirement.limit is None:
        return f"{what} violates {requirement.name}"
    ends = Ends(requirement.lower, requirement.upper)
    limit = f"limit {directed_limit(time_text(requirement.limit), is_upper=requirement.is_upper)}"
    return f"{what} is {_ends_text(ends, requirement.limit, requirement.is_upper)}, {limit}" + (
        f" ({requirement.reason})" if requirement.reason else ""
    )


def _ends_text(ends: Ends, limit: Time | None, is_upper: bool = True) -> str:
    """The end of a maximum or minimum that violates its limit, rounded as in tables."""
    if ends.upper is None and is_upper:
        return "unbounded"
    known = ends.lower if is_upper else ends.upper
    is_exact = ends.lower == ends.upper
    # "At least" stays true if rounded down, "at most" if rounded up.
    text = rounded_time_text(known or 0, Rounding.UP if is_exact is is_upper else Rounding.DOWN, limit)
    return text if is_exact else f"at {'least' if is_upper else 'most'} {text}"


def _unknown(summary: SystemSummary) -> str:
    """How much is unknown, and the most frequent cause."""
    if not summary.judged:
        return "no deadline, requirement or constraint can be judged"
    unknown = summary.unexplained
    if not unknown:
        return ""
    count = f"{len(unknown)} of {summary.judged} {'is' if len(unknown) == 1 else 'are'} unknown"
    causes = _causes(unknown)
    if not causes:
        return count
    (reason, _), *others = causes.most_common()
    first = next(item.name for item in unknown if item.reason == reason)
    more = f", and {counted(len(others), 'other cause')}" if others else ""
    return f"{count}, because of {first!r}: {reason}{more}"


def _causes(unknown: Iterable[Judged]) -> Counter[str]:
    """The reasons of unknown verdicts with their numbers; without mere consequences if there is anything else."""
    reasons = Counter(item.reason for item in unknown if item.reason)
    roots = Counter({reason: number for reason, number in reasons.items() if not reason.endswith(_CONSEQUENCE)})
    return roots or reasons
