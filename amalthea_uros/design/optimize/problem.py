"""A design problem: what may change, what must hold, what is better, and how a design is judged."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from enum import StrEnum
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.optimize.space import Candidate, Space


class Feasibility(StrEnum):
    """Whether all deadlines and limits hold: proved, refuted, or neither."""

    YES = "yes"
    NO = "no"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignEvaluation:
    """What the full analysis says of a design; small enough to be sent between computers.

    Attributes
    ----------
    feasible : NO only if a deadline or limit is missed for certain
    violations : deadline or limit -> by how many picoseconds it is exceeded; None if that is not known
    values : of the goals in their order, less is better; None if unknown
    is_exact : whether all verdicts and values are exact, not bounds
    is_excluded : whether a lower bound shows that a limit is exceeded, so that the design is not analysed
    broken_rule : the rule of the space that the design breaks, so that it is not analysed; "" if there is none
    reason : why there is no analysis, "" if there is one
    work : of the analysis, in jobs
    """

    candidate: Candidate
    feasible: Feasibility
    violations: Mapping[str, int | None] = field(default_factory=dict)
    values: tuple[Fraction | None, ...] = ()
    is_exact: bool = False
    is_excluded: bool = False
    broken_rule: str = ""
    reason: str = ""
    work: int = field(default=0, compare=False)

    @property
    def changes(self) -> int:
        """The number of changed values."""
        return len(self.candidate)


#: Judges designs, several at a time so that they can be judged in parallel; the results have the order of the candidates, and those of
#: the first ones can be there before the last ones are judged.
Evaluator: TypeAlias = Callable[[Sequence[Candidate]], Iterable[DesignEvaluation]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """Something to minimise, such as the largest latency relative to its limit.

    Attributes
    ----------
    name : as on the command line
    unit : "ps", or "" for a share or a number
    """

    name: str
    unit: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """A design problem.

    Attributes
    ----------
    present : the system and settings as they are
    configure : the system and settings of a design; InvalidArgumentError if it is impossible
    goals : the first one counts most; where they are equal, the next one, and in the end the number of changes
    seed : of all random numbers
    named : objects and their quantities of which limits and goals speak by name
    """

    present: Configuration
    space: Space
    goals: tuple[Goal, ...]
    configure: Callable[[Candidate], Configuration]
    evaluate: Evaluator
    seed: int = 1
    named: frozenset[tuple[str, str]] = frozenset()


class Conclusion(StrEnum):
    """What a search can say in the end; `OPTIMAL` and `NONE` are proved for all designs of the space.

    Attributes
    ----------
    OPTIMAL : no design that is proved to meet all limits is better
    NONE : each design misses a limit for certain
    """

    OPTIMAL = "optimal"
    BEST_FOUND = "best found"
    NONE = "none exists"
    NOT_FOUND = "none found"


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchResult:
    """What a search found.

    Attributes
    ----------
    best : feasible designs, the best first
    front : designs of which none is better in every goal than another one
    tried : number of designs that were judged
    excluded : number of designs of the space that a proof excludes without judging each
    broken : rule of the space -> number of designs that break it; they are neither tried nor excluded
    undecided : number of the designs that were tried of which it is unknown whether all limits hold
    proof : why it is optimal, or why none exists, in words that can be checked
    ended : why the search ended early, such as "time limit"; "" if it did not
    is_exhaustive : whether the proof is that all designs with few changed values, or all, were judged one by one
    """

    best: tuple[DesignEvaluation, ...]
    front: tuple[DesignEvaluation, ...]
    conclusion: Conclusion
    tried: int
    excluded: int = 0
    broken: Mapping[str, int] = field(default_factory=dict)
    undecided: int = 0
    proof: str = ""
    ended: str = ""
    is_exhaustive: bool = False
