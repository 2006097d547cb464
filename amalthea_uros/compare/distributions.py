"""How far measured and simulated distributions are apart."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros.compare.agreement import Rule
from amalthea_uros.compare.naming import Target
from amalthea_uros.compare.predictions import overhead_of
from amalthea_uros.compare.results import (
    Agreement,
    ComparisonRow,
    DistributionRow,
    Statistic,
)
from amalthea_uros.compare.simulated import Run
from amalthea_uros.measure.series import Distance, MeasuredKind, Series, TimeStatistics, distance
from amalthea_uros.timing.stated_distributions import Basis
from amalthea_uros.units import Time

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def distributions(
    found: Sequence[Target],
    rows: Sequence[ComparisonRow],
    runs: Sequence[Run],
    rule: Rule,
    overheads: Mapping[str, Time],
    basis_of: Callable[[Target], Basis],
) -> Iterator[DistributionRow]:
    """The distances of all quantities of which both have the values; of several phases, the nearest one or all together."""
    simulated = _simulated_values(runs)
    agreeing = {
        (row.object, row.quantity) for row in rows if row.statistic is Statistic.MEAN and row.verdict is Agreement.WITHIN
    }
    for target in found:
        values = target.series.values
        others = simulated.get((target.kind, target.name, target.quantity), ())
        if target.reason or target.series.is_least or values is None or not len(values) or not others:
            continue
        added = overhead_of(target.name, target.quantity, overheads)
        between = min((distance(values, other + added) for other in others), key=_farness)
        is_hidden = (
            (target.name, target.quantity) in agreeing and _differs(between, rule, target.series) and not basis_of(target).open
        )
        yield DistributionRow(
            object=target.name, kind=target.kind, quantity=target.quantity, distance=between, is_hidden=is_hidden
        )


def _simulated_values(runs: Sequence[Run]) -> Mapping[tuple[MeasuredKind, str, str], list[NDArray[np.int64]]]:
    """The values of each quantity in all runs where they differ, and those of all runs together."""
    import numpy as np

    found: dict[tuple[MeasuredKind, str, str], dict[object, NDArray[np.int64]]] = {}
    for run in runs:
        for each in run.values.series:
            if each.values is not None and each.statistics is not None:
                found.setdefault((each.kind, each.name, each.quantity), {}).setdefault(_key(each.statistics), each.values)
    samples = {key: list(different.values()) for key, different in found.items()}
    return {key: [*each, np.concatenate(each)] if len(each) > 1 else each for key, each in samples.items()}


def _key(statistics: TimeStatistics) -> tuple[object, ...]:
    """Samples that differ in none of these are taken as equal."""
    return statistics.min, statistics.mean, statistics.max, statistics.variance


def _farness(between: Distance) -> tuple[Fraction, int]:
    """Which of several distributions is nearer; those without a common value differ by their quantiles."""
    return between.value, sum(abs(measured - simulated) for measured, simulated in between.quantiles.values())


def _differs(between: Distance, rule: Rule, series: Series) -> bool:
    """Whether distributions differ by more than chance, and at some quantile by more than tolerance and uncertainty."""
    baseline = series.baseline
    uncertainty = Fraction(rule.uncertainty) + (0 if baseline is None else baseline.max - baseline.min)

    def is_far(measured: Time, simulated: Time) -> bool:
        difference = abs(measured - simulated)
        return difference > rule.tolerance * abs(measured) and difference > uncertainty

    return between.is_significant and any(is_far(*both) for both in between.quantiles.values())
