"""What a sweep tries: sweeps in the forms of callers, and the variants of their combinations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from amalthea_uros.design.campaign.run import Run
from amalthea_uros.design.changes.change import split_target
from amalthea_uros.design.changes.sweep import FORM, Sweep, combinations, parse_sweep, sampled, variants
from amalthea_uros.errors import InvalidArgumentError

#: Sweeps as callers give them: `{"Task.period": ["1 ms", "2 ms"]}` or `["Task.period=1ms..5ms/1ms"]`.
Sweeps: TypeAlias = Mapping[str, Sequence[object]] | Iterable[str | Sweep]


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepPlan:
    """What is to be analysed.

    Attributes
    ----------
    sweeps : the values to try
    runs : the variants
    total : number of all combinations, of which a sample has fewer
    seed : of the sample; None without one
    """

    sweeps: tuple[Sweep, ...]
    runs: tuple[Run, ...]
    total: int
    seed: int | None


def plan_sweep(sweeps: tuple[Sweep, ...], sample: int | None = None, seed: int = 1) -> SweepPlan:
    """The variants of all combinations, or of a sample.

    Raises
    ------
    InvalidArgumentError : nothing is swept, a sample without anything, too many combinations, or two sweeps of one property.
    """
    if not sweeps:
        raise InvalidArgumentError(f"nothing is swept; expected {FORM}")
    if sample is not None and sample < 1:
        raise InvalidArgumentError(f"a sample of {sample} variants is not possible; expected at least 1")
    found = variants(sweeps) if sample is None else sampled(sweeps, sample, seed)
    runs = tuple(Run(number, seed, changes) for number, changes in enumerate(found, start=1))
    return SweepPlan(sweeps=sweeps, runs=runs, total=combinations(sweeps), seed=None if sample is None else seed)


def as_sweeps(sweeps: Sweeps) -> tuple[Sweep, ...]:
    """Sweeps in any of the forms that callers give.

    Raises
    ------
    InvalidArgumentError : a text is not of the form of a sweep, or a list of values is empty.
    """
    if isinstance(sweeps, Mapping):
        return tuple(_listed(target, values) for target, values in sweeps.items())
    texts: Sequence[str | Sweep] = [sweeps] if isinstance(sweeps, str) else list(sweeps)
    return tuple(each if isinstance(each, Sweep) else parse_sweep(each) for each in texts)


def _listed(target: str, values: Sequence[object]) -> Sweep:
    if isinstance(values, str):
        return parse_sweep(f"{target}={values}")
    if not values:
        raise InvalidArgumentError(f"{target!r} has no values to try")
    return Sweep(*split_target(target, target, FORM, "Executor_Task.period"), tuple(map(str, values)))
