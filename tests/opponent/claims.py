"""What an analysis claims about a system, against what was observed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction

from opponent.observation import Observation, observe
from opponent.systems import PlainSystem, constructs_of
from opponent.to_perf import MICROSECOND, to_perf

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.timing.response import Claim

#: How many readings are played at first, and at most to confirm a suspicion: systems with hundreds of them are not worth the time.
FEW_READINGS, MOST_READINGS = 4, 48


@dataclass(frozen=True, slots=True, kw_only=True)
class FalseClaim:
    """A claim that an observation refutes; times in microseconds.

    Attributes
    ----------
    subject : the process, or "chain"
    quantity : worst, best, or the quantity of the chain, or "crash"
    """

    subject: str
    quantity: str
    claimed: Fraction | None = None
    observed: int | None = None
    claim: str = ""
    method: str = ""

    def __str__(self) -> str:
        return f"{self.subject}: {self.quantity} {self.claimed} ({self.claim} by {self.method}), but {self.observed} occurs"


@dataclass(slots=True)
class Tally:
    """How many processes and chains there are with each construct, and how many of them are unknown."""

    total: Counter[str] = field(default_factory=Counter)
    unknown: Counter[str] = field(default_factory=Counter)
    reasons: Counter[str] = field(default_factory=Counter)

    def add(self, constructs: frozenset[str], *, is_unknown: bool, reason: str) -> None:
        """One more process or chain of a system with these constructs."""
        self.total.update(constructs)
        if is_unknown:
            self.unknown.update(constructs)
            self.reasons[reason] += 1

    def add_analysis(self, analysis: Analysis, constructs: frozenset[str]) -> None:
        """The processes and chains of a system."""
        for process in analysis.processes:
            is_unknown = process.response is None or process.response.worst is None
            self.add(constructs, is_unknown=is_unknown, reason=process.reason)
        for chain in analysis.chains:
            self.add(constructs, is_unknown=not chain.values, reason=chain.reason)

    def add_all(self, other: Tally) -> None:
        """What was counted elsewhere."""
        self.total += other.total
        self.unknown += other.unknown
        self.reasons += other.reasons

    def shares(self) -> dict[str, float]:
        """The share of unknowns by construct."""
        return {name: self.unknown[name] / self.total[name] for name in sorted(self.total)}

    def text(self) -> str:
        """The shares and the most frequent reasons, readable."""
        lines = [f"{self.unknown[name]:5} of {self.total[name]:5} unknown with {name}" for name in sorted(self.total)]
        return "\n".join([*lines, *(f"{count:5} times: {reason}" for reason, count in self.reasons.most_common(10))])


def false_claims(system: PlainSystem, plays: int, tally: Tally | None = None) -> list[FalseClaim]:
    """The false claims about a system, a crash included; unknowns are counted.

    Some readings show what is suspicious, all of them whether it is wrong.
    """
    try:
        analysis = analyze_system(to_perf(system))
    except Exception as error:  # whatever it is, it is a finding
        return [FalseClaim(subject="analysis", quantity="crash", method=repr(error))]
    if tally is not None:
        tally.add_analysis(analysis, constructs_of(system))
    if not refuted(analysis, observe(system, range(plays), FEW_READINGS)):
        return []
    return refuted(analysis, observe(system, range(plays), MOST_READINGS))


def refuted(analysis: Analysis, observed: Observation) -> list[FalseClaim]:
    """The claims that an observation refutes."""
    return [*_false_responses(analysis, observed), *_false_latencies(analysis, observed)]


def _false_responses(analysis: Analysis, observed: Observation) -> Iterator[FalseClaim]:
    for process in analysis.processes:
        response, name = process.response, process.name
        if response is None:
            continue
        is_exact = response.claim is Claim.EXACT and name in observed.determined
        if response.worst is not None and name in observed.worst:
            worst, occurs = Fraction(response.worst, MICROSECOND), observed.worst[name]
            if worst < occurs or (is_exact and worst != occurs):
                yield FalseClaim(
                    subject=name, quantity="worst", claimed=worst, observed=occurs, claim=response.claim, method=response.method
                )
        if name in observed.best:
            best, occurs = Fraction(response.best, MICROSECOND), observed.best[name]
            if best > occurs or (is_exact and response.worst is not None and best != occurs):
                yield FalseClaim(
                    subject=name, quantity="best", claimed=best, observed=occurs, claim=response.claim, method=response.method
                )


def _false_latencies(analysis: Analysis, observed: Observation) -> Iterator[FalseClaim]:
    for value in (value for chain in analysis.chains for value in chain.all_values):
        quantity = value.quantity.value
        if value.value is None or quantity not in observed.chain:
            continue
        claimed, occurs = Fraction(value.value, MICROSECOND), observed.chain[quantity]
        is_wrong = claimed < occurs if value.quantity.is_upper else claimed > occurs
        if is_wrong or (value.claim is Claim.EXACT and quantity in observed.determined and claimed != occurs):
            yield FalseClaim(
                subject="chain", quantity=quantity, claimed=claimed, observed=occurs, claim=value.claim, method=value.method
            )
