"""What a report puts first: the limits that are missed, unknown or nearly reached, and the worst chains."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from math import inf
from typing import TypeAlias

from amalthea_uros.analyze.results.analysis import Analysis, Judged
from amalthea_uros.analyze.results.chains import LIMITED, ChainResult, LatencyQuantity
from amalthea_uros.analyze.results.processes import ProcessResult, RequirementResult
from amalthea_uros.judge.causes import quantity_of
from amalthea_uros.judge.summary import urgency
from amalthea_uros.judge.verdict import FAILURES, WORST_FIRST, Verdict
from amalthea_uros.report.basics.document import Cell, Table, table
from amalthea_uros.report.wording.cells import UNKNOWN, at_least, at_most, limited_text, load_text, verdict_badge
from amalthea_uros.timing.basics.quantities import jitter_name
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Rounding, Time, number_text, time_text

#: Sorts the worst first.
_Rank: TypeAlias = tuple[int, Fraction | float]
_LAST: _Rank = (len(WORST_FIRST), inf)
#: With those whose jitter is limited.
_CONCERNED = LIMITED | {jitter_name(name): quantity for name, quantity in LIMITED.items()}


def judged_items(analysis: Analysis) -> list[Judged]:
    """All deadlines, requirements and constraints, the worst first: what fails, what is unknown, then what uses most of its limit.

    A deadline that is also stated as a requirement is there once, unless its process fails in another way: by lost activations.
    """
    stated = {(quantity_of(each), each.limit): each.verdict for each in analysis.requirements}
    processes = (
        each
        for each in analysis.processes
        if each.verdict is not None
        and (each.is_implicit or _is_worse(each.verdict, stated.get((quantity_of(each), each.limit))))
    )
    return sorted([*processes, *analysis.requirements], key=urgency)


def _is_worse(verdict: Verdict, stated: Verdict | None) -> bool:
    return stated is None or (stated not in FAILURES and WORST_FIRST.index(verdict) < WORST_FIRST.index(stated))


def concerned(item: Judged) -> str:
    """The process or chain of which a deadline or requirement is."""
    return item.name if isinstance(item, ProcessResult) else item.object


def limits_table(analysis: Analysis) -> Table:
    """All deadlines, requirements and constraints with their values, and how much of their limits these use."""
    values = ((chain.name, name, chain.value(quantity)) for chain in analysis.chains for name, quantity in LIMITED.items())
    # The claims of the results that requirements may limit, by object and quantity.
    claims = {
        **{(each.name, "response time"): _claim(each) for each in analysis.processes},
        **{(chain, name): str(value.claim) for chain, name, value in values if value is not None},
    }
    columns = ("requirement", "verdict", "what", ">value", ">limit", ">used", ">margin", "claim", "why")
    rows = (_row(item, claims) for item in judged_items(analysis))
    return table("Deadlines, requirements and constraints", columns, rows)


def _row(item: Judged, claims: Mapping[tuple[str, str], str]) -> tuple[Cell, ...]:
    if isinstance(item, ProcessResult):
        what = "response time, period" if item.is_implicit else "response time, deadline"
        lower = upper = item.response.worst if item.response is not None else None
        claim = _claim(item)
    else:
        what = limited_text(item.quantity, item.object)
        lower, upper, claim = item.lower, item.upper, _requirement_claim(item, claims)
    value, used = _value_text(item, lower, upper), _used(upper, item) if item.is_upper else "-"
    return (item.name, verdict_badge(item), what, value, limit_text(item), used, margin_text(item), claim, why(item))


def _value_text(item: Judged, lower: Time | None, upper: Time | None) -> str:
    """The safe end; both ends where the verdict depends on where between them the value is."""
    if item.verdict is Verdict.MET or lower == upper or lower is None or upper is None:
        safe = upper if item.is_upper else lower
        if safe is None:
            return "no bound" if item.verdict in FAILURES else UNKNOWN
        return (at_most if item.is_upper else at_least)(safe, item.limit)
    return f"{at_least(lower, item.limit)} to {at_most(upper, item.limit)}"


def limit_text(item: Judged) -> str:
    """The limit with its direction."""
    limit = stated_limit(item)
    return f"{'≤' if item.is_upper else '≥'} {limit}" if limit else "-"


def stated_limit(item: Judged) -> str:
    """The limit of a time or of a number; "" if there is none."""
    if item.limit is not None:
        return time_text(item.limit)
    return number_text(item.stated.limit) if item.stated is not None and item.stated.limit is not None else ""


def margin_text(item: Judged) -> str:
    """The distance from the limit, where it is certain."""
    if item.margin is None or item.verdict is Verdict.UNKNOWN:
        return "-"
    return at_least(item.margin)


def _used(value: Time | None, item: Judged) -> str:
    """The share of the limit; where the verdict is unknown, the value is anywhere below its bound."""
    if value is None or not item.limit:
        return "-"
    share = load_text(Fraction(value, item.limit), Rounding.UP)
    return f"up to {share}" if item.verdict is Verdict.UNKNOWN else share


def _claim(process: ProcessResult) -> str:
    return str(process.response.claim) if process.response is not None and process.response.worst is not None else ""


def _requirement_claim(requirement: RequirementResult, claims: Mapping[tuple[str, str], str]) -> str:
    """That of the value; a worst-case response time or latency has the same claim as in the results of its process or chain."""
    if requirement.value is None:
        return ""
    if requirement.is_upper and (requirement.object, requirement.quantity) in claims:
        return claims[requirement.object, requirement.quantity]
    return str(Claim.EXACT if requirement.lower == requirement.upper else Claim.BOUND)


def why(item: Judged) -> str:
    """Why a verdict is not met."""
    if item.reason or item.verdict is Verdict.MET or item.margin is None or item.verdict is Verdict.UNKNOWN:
        return item.reason
    if item.margin >= 0:
        return ""
    return f"{'exceeds' if item.is_upper else 'falls short of'} its limit by {at_most(-item.margin)}"


def worst_chains(analysis: Analysis) -> list[ChainResult]:
    """The chains, those with the worst requirements first, then by reaction time."""
    ranks = _ranks(analysis.requirements)
    return sorted(analysis.chains, key=lambda chain: (ranks.get(chain.name, _LAST), -_reaction(chain)))


def _ranks(requirements: Iterable[RequirementResult]) -> dict[str, _Rank]:
    found: dict[str, _Rank] = {}
    for requirement in sorted(requirements, key=urgency):
        found.setdefault(requirement.object, urgency(requirement))
    return found


def _reaction(chain: ChainResult) -> float:
    value = chain.value(LatencyQuantity.MAX_REDUCED_REACTION_TIME)
    return inf if value is None or value.value is None else value.value


def requirements_of(chain: str, analysis: Analysis) -> Sequence[RequirementResult]:
    """The requirements on the latencies of a chain and on their jitter, the worst first."""
    return sorted((each for each in analysis.requirements if each.object == chain and each.quantity in _CONCERNED), key=urgency)


def decisive_quantity(chain: str, analysis: Analysis) -> LatencyQuantity:
    """The latency of a chain with the worst requirement; without one, its reaction time."""
    requirements = requirements_of(chain, analysis)
    return _CONCERNED[requirements[0].quantity] if requirements else LatencyQuantity.MAX_REDUCED_REACTION_TIME
