"""The simulations of the variants of a system, each as a row of a table; they can be sent to other computers."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros._internal.limits import CAMPAIGN_OCCURRENCES
from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.campaign.run import CampaignRun, Record, RunOutcome, VariantJob, VariantResults
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.verdict import ObservedVerdict
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import Options
from amalthea_uros.units import time_text

#: The end of the columns with verdicts in a row of a table.
_VERDICT = ".verdict"
#: The column with what was not simulated.
_ERRORS = "errors"


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignResult(Brief, VariantResults):
    """Many simulations of some files.

    Attributes
    ----------
    planned : number of runs
    """

    paths: tuple[Path, ...]
    options: Options
    planned: int

    @property
    def is_failed(self) -> bool:
        """Whether a run failed, or in one a limit was missed, an activation was lost, or not everything was simulated."""
        return bool(self.failed or self.missed or self.incomplete)

    @property
    def is_complete(self) -> bool:
        """Whether all runs were executed."""
        return len(self.outcomes) == self.planned

    @property
    def incomplete(self) -> tuple[RunOutcome, ...]:
        """The runs in which not everything was simulated."""
        return tuple(outcome for outcome in self.outcomes if outcome.record.get(_ERRORS))

    @property
    def missed(self) -> tuple[RunOutcome, ...]:
        """The runs in which a limit was observed as missed, or an activation was lost."""
        return self._with_verdict(ObservedVerdict.MISSED)

    @property
    def not_observed(self) -> tuple[RunOutcome, ...]:
        """The runs in which a limit was neither observed as kept nor as missed."""
        return self._with_verdict(ObservedVerdict.NOT_OBSERVED)

    @property
    def is_anything_kept(self) -> bool:
        """Whether a limit was observed as kept in a run."""
        return bool(self._with_verdict(ObservedVerdict.OK))

    def _with_verdict(self, verdict: ObservedVerdict) -> tuple[RunOutcome, ...]:
        return tuple(outcome for outcome in self.outcomes if judged_in(outcome.record, verdict))


def judged_in(record: Record, verdict: ObservedVerdict) -> list[str]:
    """What has a verdict in a run, by the columns with verdicts; lost activations are one that was missed."""
    return [name.removesuffix(_VERDICT) for name, value in record.items() if name.endswith(_VERDICT) and value == verdict]


def require_bounded_work(system: System, options: Options, runs: int) -> None:
    """Refuse a campaign that would take days.

    Raises
    ------
    InvalidArgumentError : the stimuli occur more often in all runs together than is simulated.
    """
    from amalthea_uros.simulate.arrivals import least_count

    counts = {stimulus.name: least_count(stimulus, options.duration) for stimulus in system.stimuli.stimuli}
    if (total := runs * sum(counts.values())) > CAMPAIGN_OCCURRENCES:
        most = max(counts, key=lambda name: counts[name])
        raise InvalidArgumentError(
            f"in {counted(runs, 'run')} of {time_text(options.duration)} there are {total:,} activations, most by {most!r}; "
            f"at most {CAMPAIGN_OCCURRENCES:,} are simulated; use fewer runs or a shorter duration"
        )


@dataclass(frozen=True, slots=True)
class SimulationJob(VariantJob):
    """Simulates the system of a run with its seed; the options have the settings of the origin."""

    options: Options

    def __call__(self, run: CampaignRun) -> Record:
        """The observations of a run as a row of a table."""
        from amalthea_uros.simulate.runs.run import simulate_system

        changed = self.configure(run)
        return simulate_system(changed.system, replace(self.options, settings=changed.settings, seed=run.seed)).record()
