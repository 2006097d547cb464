"""Analyses of a system for many values of its properties."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.shown import Shown
from amalthea_uros.design.campaign.campaign import finished_runs
from amalthea_uros.design.campaign.executors import executor_for
from amalthea_uros.design.campaign.run import Record, RunOutcome
from amalthea_uros.design.campaign.sweeps import SCHEDULABLE, AnalysisJob, SweepPlan, Sweeps, as_sweeps, plan_sweep
from amalthea_uros.design.changes.apply import Difference, apply
from amalthea_uros.design.changes.change import Change, Sweep
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.timing_changes import described
from amalthea_uros.diagnostics import Finding
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.names import require
from amalthea_uros.services.inputs import SystemInput, as_paths, open_system
from amalthea_uros.services.names import require_settings
from amalthea_uros.services.subject import Subject, open_subject
from amalthea_uros.services.what_if import Changes, as_changes
from amalthea_uros.timing.basics.settings import Settings


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class SweepResult(Shown):
    """The analyses of all variants of a system.

    Attributes
    ----------
    outcomes : in the order of the variants; those that were not finished when somebody interrupted are absent
    differences : what the changes of all variants did
    findings : problems found while reading the files
    source : the files, as text; "" if there are none
    shown : the results that people want to see; none: the first ones that change
    """

    plan: SweepPlan
    outcomes: tuple[RunOutcome, ...]
    differences: tuple[Difference, ...] = ()
    findings: tuple[Finding, ...] = ()
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
    def failed(self) -> tuple[RunOutcome, ...]:
        """The variants that could not be analysed."""
        return tuple(outcome for outcome in self.outcomes if outcome.error)

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


#: So many variants are analysed by this process, unless somebody says by how many: others would take longer to start.
FEW = 16


def sweep(
    subject: Subject,
    sweeps: Sweeps,
    settings: Settings | None = None,
    *,
    changes: Changes = (),
    sample: int | None = None,
    seed: int = 1,
    with_growth: bool = False,
    workers: int | None = 1,
    cluster: str | None = None,
    on_outcome: Callable[[RunOutcome], None] | None = None,
) -> SweepResult:
    """Analyze each variant of whatever describes a system.

    >>> sweep("app.yaml", {"Executor_Task.period": ["1 ms", "2 ms", "5 ms"]}).to_dataframe()  # doctest: +SKIP

    Ctrl-C ends it early; the result has the variants that were finished.

    Parameters
    ----------
    subject : as for `analyze`
    sweeps : `{"OBJECT.KEY": [value, ...]}`, or texts as for `amuros sweep --sweep`; with several, all combinations
    changes : made in all variants
    sample : number of combinations chosen at random, by the seed; None: all of them
    with_growth : also find out by what factor all execution times may grow together before something is missed
    workers : analyses at the same time on this computer; None: as many as there are cores
    cluster : address of a Dask scheduler, on whose workers the analyses are executed instead
    on_outcome : called after each analysis

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : the changes, sweeps or settings name what does not exist, or a value is wrong; the cluster cannot be used.
    """
    plan = plan_sweep(as_sweeps(sweeps), sample, seed)
    return sweep_opened(
        open_subject(subject),
        plan,
        settings or Settings(),
        as_changes(changes),
        with_growth=with_growth,
        workers=workers,
        cluster=cluster,
        on_outcome=on_outcome,
    )


def sweep_files(
    paths: StrPath | Iterable[StrPath],
    plan: SweepPlan,
    settings: Settings,
    changes: Sequence[Change] = (),
    *,
    with_growth: bool = False,
    with_bus: bool = False,
    workers: int | None = None,
    cluster: str | None = None,
    on_outcome: Callable[[RunOutcome], None] | None = None,
) -> SweepResult:
    """Analyze each variant of an `app.yaml` or of AMALTHEA models; parameters and errors as for `sweep`.

    Parameters
    ----------
    with_bus : also analyze the messages on the CAN bus of an `app.yaml`
    """
    files = as_paths(paths)
    opened = open_system(files, with_bus=with_bus)
    found = sweep_opened(
        opened,
        plan,
        settings,
        changes,
        with_growth=with_growth,
        workers=workers,
        cluster=cluster,
        on_outcome=on_outcome,
    )
    return replace(found, source=" ".join(map(str, files)))


def sweep_opened(
    opened: SystemInput,
    plan: SweepPlan,
    settings: Settings,
    changes: Sequence[Change] = (),
    *,
    with_growth: bool = False,
    workers: int | None = None,
    cluster: str | None = None,
    on_outcome: Callable[[RunOutcome], None] | None = None,
) -> SweepResult:
    """Analyze each variant of what was opened; parameters and errors as for `sweep`."""
    present = Configuration(opened.system, settings)
    require_settings(present.settings, present.system)
    differences = described(present, changes)
    _check_values(present, changes, plan.sweeps)
    job = AnalysisJob(*present, tuple(changes), with_growth)
    few = workers is None and len(plan.runs) <= FEW
    executor = executor_for(len(plan.runs), 1 if few else workers, cluster)
    return SweepResult(
        plan=plan,
        outcomes=finished_runs(job, plan.runs, executor, on_outcome),
        differences=differences,
        findings=unsuppressed(opened.findings),
    )


def _check_values(present: Configuration, changes: Sequence[Change], sweeps: Sequence[Sweep]) -> None:
    """Refuse wrong names and values before the first analysis; of long sweeps the ends are tried."""
    for each in sweeps:
        for value in (each.values[0], each.values[-1]):
            changed = apply(*present, (*changes, Change(each.object, each.key, value)))
            require_settings(changed.settings, changed.system)
