"""The runs of a campaign, what comes out of them, and systems as bytes to be sent to other processes."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import partial
from io import BytesIO
from typing import Any, TypeAlias

from amalthea_uros._internal.records import dataclass, fields
from amalthea_uros._internal.shown import Shown
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.change import Change, Sweep, count_variants, variants
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.origin import ChangeOrigin
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import parse_frequency, parse_time

Value: TypeAlias = int | float | str | None
#: A row of a table: column -> value.
Record: TypeAlias = Mapping[str, Value]

#: More runs than this are a mistake rather than a plan.
MAX_RUNS = 1_000_000


@dataclass(frozen=True, slots=True)
class CampaignRun:
    """One run; its result depends on nothing else.

    Attributes
    ----------
    number : from 1, in the order of the table
    """

    number: int
    seed: int
    changes: tuple[Change, ...] = ()

    def columns(self) -> dict[str, Value]:
        """The columns that identify it in a table."""
        return {"run": self.number, "seed": self.seed, **dict(map(_column, self.changes))}


#: What is done in each run; it must be possible to send it, and what it gives, to another process.
Job: TypeAlias = Callable[[CampaignRun], Mapping[str, Any]]


@dataclass(frozen=True, slots=True)
class RunOutcome:
    """What came out of a run.

    Attributes
    ----------
    record : what the job gave, for most jobs a row of a table; empty if the run failed
    error : why it failed, "" if it did not
    """

    run: CampaignRun
    record: Mapping[str, Any]
    error: str = ""

    def row(self) -> Record:
        """The run and its results as a row of a table."""
        return {**self.run.columns(), **self.record, **({"error": self.error} if self.error else {})}


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class VariantResults(Shown):
    """What came out of the runs of all variants of a system.

    Attributes
    ----------
    outcomes : in the order of the runs; those that were not finished when somebody interrupted are absent
    differences : what the changes of all variants did
    findings : problems found while reading the files
    """

    outcomes: tuple[RunOutcome, ...]
    differences: tuple[Difference, ...] = ()
    findings: tuple[Finding, ...] = ()

    @property
    def rows(self) -> list[Record]:
        """The rows of a table of all runs."""
        return [outcome.row() for outcome in self.outcomes]

    @property
    def failed(self) -> tuple[RunOutcome, ...]:
        """The runs that could not be executed."""
        return tuple(outcome for outcome in self.outcomes if outcome.error)


def plan_runs(sweeps: Sequence[Sweep], repetitions: int, seed: int) -> tuple[CampaignRun, ...]:
    """The runs of all variants; the repetitions of each have the seeds from `seed` on.

    Raises
    ------
    InvalidArgumentError : more than `MAX_RUNS`, no repetition, or as for `variants`.
    """
    count_runs(sweeps, repetitions)
    pairs = ((changes, seed + repetition) for changes in variants(sweeps) for repetition in range(repetitions))
    return tuple(CampaignRun(number, each, changes) for number, (changes, each) in enumerate(pairs, start=1))


def count_runs(sweeps: Sequence[Sweep], repetitions: int) -> int:
    """The number of runs; raises as `plan_runs`."""
    if repetitions < 1:
        raise InvalidArgumentError(f"{repetitions} runs of each variant are not possible; expected at least 1")
    if (count := count_variants(sweeps) * repetitions) > MAX_RUNS:
        raise InvalidArgumentError(f"the campaign has {count:,} runs; at most {MAX_RUNS:,} are possible")
    return count


def _column(change: Change) -> tuple[str, Value]:
    """The column of a changed value: numbers in the internal unit, which the name of the column has."""
    readings: tuple[tuple[str, Callable[[str], int | Fraction]], ...] = (
        ("", int),
        ("_ps", parse_time),
        ("_hz", parse_frequency),
    )
    for suffix, read in readings:
        try:
            number = read(change.value)
        except ValueError:
            continue
        return change.target + suffix, int(number) if number.denominator == 1 else float(number)
    return change.target, change.value


def compact_bytes(value: object) -> bytes:
    """Something with systems, without their way back to objects and files."""
    stream = BytesIO()
    _Pickler(stream, pickle.HIGHEST_PROTOCOL).dump(value)
    return stream.getvalue()


@dataclass(frozen=True, slots=True)
class VariantJob:
    """What is done with a system that has the changes of a run; it is sent without the objects and files of the system.

    Attributes
    ----------
    changes : of all runs
    """

    origin: ChangeOrigin
    changes: tuple[Change, ...]

    def configure(self, run: CampaignRun) -> Configuration:
        """The system and the settings of a run; InvalidArgumentError if something is wrong with a change."""
        return self.origin.configure((*self.changes, *run.changes))

    def __reduce__(self) -> tuple[object, ...]:
        _, *others = (getattr(self, field.name) for field in fields(self))
        return _received, (type(self), compact_bytes(self.origin), *others)


def _received(kind: type[VariantJob], origin: bytes, *others: Any) -> VariantJob:
    return kind(pickle.loads(origin), *others)


class _Pickler(pickle.Pickler):
    def reducer_override(self, obj: Any) -> Any:
        """Leave out what finds the place of an activity in a file: it holds the whole AMALTHEA model."""
        return (_nowhere, ()) if isinstance(obj, partial) else NotImplemented


def _nowhere() -> None:
    """The place of an activity that was sent."""
