"""What a sweep tries, and the analysis of one variant as a row of a table; it can be sent to other computers."""

from __future__ import annotations

from collections import Counter

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.impact import ComparedFigure, FigureUnit, figures
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.sensitivity import max_growth
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.campaign.run import CampaignRun, Record, RunOutcome, Value, VariantJob, VariantResults
from amalthea_uros.design.changes.change import SWEEP_FORM, Sweep, combinations, sampled, variants
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.names import require


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
    runs: tuple[CampaignRun, ...]
    total: int
    seed: int | None


def plan_sweep(sweeps: tuple[Sweep, ...], sample: int | None = None, seed: int = 1) -> SweepPlan:
    """The variants of all combinations, or of a sample.

    Raises
    ------
    InvalidArgumentError : nothing is swept, a sample without anything, too many combinations, or two sweeps of one property.
    """
    if not sweeps:
        raise InvalidArgumentError(f"nothing is swept; expected {SWEEP_FORM}")
    if sample is not None and sample < 1:
        raise InvalidArgumentError(f"a sample of {sample} variants is not possible; expected at least 1")
    found = variants(sweeps) if sample is None else sampled(sweeps, sample, seed)
    runs = tuple(CampaignRun(number, seed, changes) for number, changes in enumerate(found, start=1))
    return SweepPlan(sweeps=sweeps, runs=runs, total=combinations(sweeps), seed=None if sample is None else seed)


SCHEDULABLE, GROWTH = "schedulable", "maximum_growth"


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class SweepResult(VariantResults):
    """The analyses of all variants of a system.

    Attributes
    ----------
    source : the files, as text; "" if there are none
    shown : the results that people want to see; none: the first ones that change
    """

    plan: SweepPlan
    source: str = ""
    shown: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<SweepResult: {len(self.outcomes)} variants, schedulable {len(self.schedulable)}>"

    @property
    def rows(self) -> list[Record]:
        """The rows of a table of all variants."""
        return [{name: value for name, value in outcome.row().items() if name != "seed"} for outcome in self.outcomes]

    @property
    def schedulable(self) -> tuple[RunOutcome, ...]:
        """The variants in which everything is met for certain."""
        return self.with_verdict(Schedulable.YES)

    def with_verdict(self, verdict: Schedulable) -> tuple[RunOutcome, ...]:
        """The variants with a verdict on the whole system."""
        return tuple(outcome for outcome in self.outcomes if outcome.record.get(SCHEDULABLE) == verdict)

    @property
    def is_complete(self) -> bool:
        """Whether all variants were analysed."""
        return len(self.outcomes) == len(self.plan.runs)

    @property
    def quantities(self) -> tuple[str, ...]:
        """The columns with results, as in the table."""
        return tuple(dict.fromkeys(name for outcome in self.outcomes for name in outcome.record))

    @property
    def changing(self) -> tuple[str, ...]:
        """The columns that are not equal in all variants."""
        records = [outcome.record for outcome in self.outcomes if not outcome.error]
        return tuple(name for name in self.quantities if len({record.get(name) for record in records}) > 1)

    def column(self, quantity: str) -> str:
        """The column of a quantity, which need not have the end that says its unit.

        Raises
        ------
        InvalidArgumentError : there is no such column; says what it may mean.
        """
        known = {name.removesuffix("_ps"): name for name in self.quantities}
        require("quantity", [quantity.removesuffix("_ps")], known)
        return known[quantity.removesuffix("_ps")]


@dataclass(frozen=True, slots=True)
class AnalysisJob(VariantJob):
    """Analyses the system of a run."""

    with_growth: bool = False

    def __call__(self, run: CampaignRun) -> Record:
        """The results as a row of a table."""
        analysis = analyze_system(*self.configure(run))
        found = _record(analysis)
        if self.with_growth:
            growth = max_growth(analysis)
            found[GROWTH] = None if growth is None else float(growth)
        return found


def _record(analysis: Analysis) -> dict[str, Value]:
    """The compared figures of an analysis, by names such as "Executor_Task.worst_case_response_time_ps"."""
    found: dict[str, Value] = {}
    names: Counter[str] = Counter()
    for figure in figures(analysis):
        name = f"{figure.object}.{figure.quantity}".removeprefix(".")
        names[name] += 1
        # Requirements of one name can limit several quantities.
        number = f" {names[name]}" if names[name] > 1 else ""
        found[name + number + ("_ps" if figure.unit is FigureUnit.TIME else "")] = _cell(figure)
    return found


def _cell(figure: ComparedFigure) -> Value:
    value = figure.value
    if value is None or isinstance(value, str):
        return None if value is None else str(value)
    return int(value) if figure.unit is FigureUnit.TIME else float(value)
