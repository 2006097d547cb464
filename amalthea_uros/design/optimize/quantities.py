"""Quantities of a design that limits and goals name, as `OBJECT.QUANTITY`, and limits of them beside those of the model."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from enum import StrEnum
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult, LatencyQuantity
from amalthea_uros.analyze.results.processes import Metric, ProcessResult
from amalthea_uros.design.changes.change import split_target
from amalthea_uros.design.optimize.problem import Feasibility
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.evidence import Ends
from amalthea_uros.judge.verdict import Verdict, decide
from amalthea_uros.names import require
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import parse_time

#: Of a chain that begins with a message: from its arrival, which can be just after a job that looks for messages was activated.
FROM_ARRIVAL = "max_time_from_arrival"
#: Of a process: the difference of its greatest and its least response time.
JITTER = "jitter"
#: Of a core: the worst-case load; 1 is full.
LOAD = "load"

#: A time in picoseconds, or a share of a core.
Amount: TypeAlias = int | Fraction


class AmountKind(StrEnum):
    """What an amount is."""

    TIME = "time"
    SHARE = "share"


@dataclass(frozen=True, slots=True)
class Range:
    """Between which ends a maximum or minimum of a design lies; None: that end is unknown or infinite.

    Attributes
    ----------
    reason : why there is no safe end
    """

    lower: Amount | None = None
    upper: Amount | None = None
    reason: str = ""

    @property
    def is_exact(self) -> bool:
        """Whether the value is known."""
        return self.lower is not None and self.lower == self.upper


@dataclass(frozen=True, slots=True)
class Figures:
    """Finds quantities in the results of an analysis.

    Attributes
    ----------
    takers : chain that begins with a message -> process that takes the message
    """

    takers: Mapping[str, str] = field(default_factory=dict)

    def range(self, analysis: Analysis, name: str, quantity: str) -> Range:
        """The range of a quantity."""
        system = analysis.solution.context.system
        if name in system.chains and quantity in (*LatencyQuantity, FROM_ARRIVAL):
            if quantity == FROM_ARRIVAL:
                return self.from_arrival(analysis, name)
            return _of_chain(analysis.chains[name], LatencyQuantity(quantity))
        if name in system.processes:
            return _of_process(analysis.processes[name], quantity)
        if name in system.cores:
            core = analysis.processors[name]
            return Range(core.at_least, core.worst)
        return Range(reason=f"there is no {name!r} in this design")

    def from_arrival(self, analysis: Analysis, chain: str) -> Range:
        """The maximum time from the arrival of the message, or from the input, to the first response.

        A chain that does not begin with a message has its reaction time, which includes the time since the read before.
        """
        taker = self.takers.get(chain)
        if taker is None:
            return _of_chain(analysis.chains[chain], LatencyQuantity.MAX_REACTION_TIME)
        reduced = _of_chain(analysis.chains[chain], LatencyQuantity.MAX_REDUCED_REACTION_TIME)
        process = analysis.processes[taker]
        pending = process.metrics.get(JobMetric.INITIAL_PENDING_TIME)
        if reduced.upper is None:
            return reduced
        if process.max_interarrival is None or pending is None or pending.max is None:
            return Range(reason=f"the time between two activations of {taker!r}, or until it starts, is unknown")
        upper = reduced.upper + process.max_interarrival + pending.max
        is_exact = reduced.is_exact and pending.min == pending.max and process.min_interarrival == process.max_interarrival
        return Range(upper if is_exact else reduced.lower, upper)


def takers(analysis: Analysis) -> Mapping[str, str]:
    """The chains that begin with a message, with the process that takes it."""
    evaluator = ChainEvaluator(analysis.solution)
    found = {}
    for name, chain in analysis.solution.context.system.chains.items():
        first = next(iter(evaluator.stages(chain)), None)
        if first is not None and first.counter is not None and first.counter.source:
            found[name] = first.process.name
    return found


def dimension(quantity: str) -> AmountKind:
    """What the amounts of a quantity are."""
    return AmountKind.SHARE if quantity == LOAD else AmountKind.TIME


def check_quantity(system: System, name: str, quantity: str, text: str) -> None:
    """Refuse what is no quantity of an object.

    Raises
    ------
    InvalidArgumentError : says which objects or quantities there are.
    """
    known: dict[str, tuple[Iterable[str], ...]] = {}
    for names, quantities in (
        (system.chains, (*LatencyQuantity, FROM_ARRIVAL)),
        (system.processes, (*JobMetric, JITTER)),
        (system.cores, (LOAD,)),
    ):
        for each in names:
            known.setdefault(each, ())
            known[each] = (*known[each], quantities)
    require("chain, process or core", [name], known)
    every = [each for quantities in known[name] for each in quantities]
    if quantity not in every:
        listed = ", ".join(dict.fromkeys(every))
        raise InvalidArgumentError(f"{text!r}: {name!r} has no {quantity!r}; expected one of {listed}")


def _of_chain(chain: ChainResult, quantity: LatencyQuantity) -> Range:
    found = chain.value(quantity)
    if found is None or found.value is None:
        return Range(reason=(found.reason if found else "") or chain.reason or f"no {quantity} is computed")
    if found.claim is Claim.EXACT:
        return Range(found.value, found.value)
    return Range(upper=found.value) if quantity.is_upper else Range(lower=found.value)


def _of_process(process: ProcessResult, quantity: str) -> Range:
    if quantity == JobMetric.RESPONSE_TIME:
        ends = process.worst_response
        return Range(ends.lower, ends.upper, process.reason)
    metric = process.metrics.get(JobMetric.RESPONSE_TIME if quantity == JITTER else JobMetric(quantity))
    if metric is None:
        return Range(reason=process.reason or f"the {quantity} of {process.name!r} is not computed")
    if quantity == JITTER:
        return Range(metric.jitter if metric.claim is Claim.EXACT else None, metric.jitter, process.reason)
    return _of_metric(metric, process.reason)


def _of_metric(metric: Metric, reason: str) -> Range:
    ends = Ends(metric.attained[1] if metric.attained is not None else metric.min, metric.max)
    return Range(ends.lower, ends.upper, reason)


LIMIT_FORM, LIMIT_EXAMPLE = "OBJECT.QUANTITY<=VALUE", "factor-to-output.max_reduced_reaction_time<=11ms"

_FEASIBLE = {Verdict.MET: Feasibility.YES, Verdict.MISSED: Feasibility.NO, Verdict.UNKNOWN: Feasibility.UNKNOWN}
_LIMIT = re.compile(r"(?P<target>.+?)\s*(?P<sign><=|<)\s*(?P<value>[^<>=]+)", re.DOTALL)
_PERCENT = re.compile(r"(\d+(?:\.\d+)?)\s*%", re.ASCII)


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """A greatest value of a quantity of a chain, process or core.

    Attributes
    ----------
    maximum : in picoseconds, or as a share
    is_below : whether the maximum itself is too much
    reason : what it is for, if the user did not state it
    """

    object: str
    quantity: str
    maximum: Amount
    is_below: bool = False
    reason: str = ""

    @property
    def target(self) -> str:
        """The object and the quantity."""
        return f"{self.object}.{self.quantity}"

    def range(self, analysis: Analysis, figures: Figures) -> Range:
        """The range of the limited quantity."""
        return figures.range(analysis, self.object, self.quantity)

    def verdict(self, found: Range) -> Feasibility:
        """Whether it holds for certain."""
        return _FEASIBLE[decide(found.upper, found.lower, self._allows)]

    def _allows(self, value: Amount) -> bool:
        return value < self.maximum if self.is_below else value <= self.maximum


def parse_limit(text: str) -> Limit:
    """A limit written as `OBJECT.QUANTITY<=VALUE`, or with `<`; a load is limited by a percentage.

    Raises
    ------
    InvalidArgumentError : the text is not of this form.
    """
    match = _LIMIT.fullmatch(text.strip())
    if match is None:
        raise InvalidArgumentError(f"{text!r} is not of the form {LIMIT_FORM}; an example: {LIMIT_EXAMPLE}")
    name, quantity = split_target(match["target"], text, LIMIT_FORM, LIMIT_EXAMPLE)
    try:
        maximum = _amount(match["value"], quantity)
    except ValueError as error:
        raise InvalidArgumentError(f"{text}: {error}") from None
    return Limit(object=name, quantity=quantity, maximum=maximum, is_below=match["sign"] == "<")


def check_limit(limit: Limit, system: System) -> None:
    """Refuse a limit of what a system does not have; raises InvalidArgumentError."""
    check_quantity(system, limit.object, limit.quantity, limit.target)


def _amount(text: str, quantity: str) -> Amount:
    if dimension(quantity) is AmountKind.TIME:
        return parse_time(text)
    match = _PERCENT.fullmatch(text.strip())
    if match is None:
        raise ValueError(f"{text.strip()!r} is not a percentage such as '70%'")
    return Fraction(match[1]) / 100
