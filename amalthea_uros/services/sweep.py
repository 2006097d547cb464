"""Analyses of a system for many values of its properties."""

from __future__ import annotations

from collections.abc import Callable

from amalthea_uros.design.campaign.campaign import finished_runs
from amalthea_uros.design.campaign.executors import executor_for
from amalthea_uros.design.campaign.run import RunOutcome
from amalthea_uros.design.campaign.sweeps import AnalysisJob, SweepPlan, SweepResult, plan_sweep
from amalthea_uros.design.changes.change import Changes, Sweeps, as_sweeps
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.services.changed import ChangedSystem, open_changed
from amalthea_uros.services.subject import Subject
from amalthea_uros.timing.basics.settings import Settings

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
    plan, changed = plan_sweep(as_sweeps(sweeps), sample, seed), open_changed(subject, settings, changes)
    return sweep_changed(changed, plan, with_growth=with_growth, workers=workers, cluster=cluster, on_outcome=on_outcome)


def sweep_changed(
    changed: ChangedSystem,
    plan: SweepPlan,
    *,
    with_growth: bool = False,
    workers: int | None = None,
    cluster: str | None = None,
    on_outcome: Callable[[RunOutcome], None] | None = None,
) -> SweepResult:
    """Analyze each variant of what was opened; parameters and errors as for `sweep`."""
    changed.check_sweeps(plan.sweeps)
    few = workers is None and len(plan.runs) <= FEW
    executor = executor_for(len(plan.runs), 1 if few else workers, cluster)
    return SweepResult(
        plan=plan,
        outcomes=finished_runs(AnalysisJob(changed.origin, changed.changes, with_growth), plan.runs, executor, on_outcome),
        differences=changed.differences,
        findings=unsuppressed(changed.opened.findings),
        source=" ".join(map(str, changed.opened.paths)),
    )
