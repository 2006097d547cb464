"""The load of cores: what the jobs of all processes demand in the long run, each with what it triggers."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import suppress
from fractions import Fraction

from amalthea_uros._internal.graphs import reached
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Activity
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.activations import Activations
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.demand.job_paths import NOTHING, JobDemand, JobPaths, total
from amalthea_uros.timing.demand.model import DemandModel
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.units import Frequency, frequency_text


def activation_rates(system: System, activations: Activations) -> Mapping[str, Fraction]:
    """Maximum number of activations per picosecond of each process, in the long run; processes without a bound are left out."""
    found: dict[str, Fraction] = {}
    for process in system.processes.values():
        with suppress(UnknownError):
            found[process.name] = activations.of(process).rate
    return found


def suppressible(system: System, activations: Activations) -> frozenset[str]:
    """The processes of which conditions of stimuli may suppress activations."""
    found = set()
    for process in system.processes.values():
        with suppress(UnknownError):
            if activations.of(process).can_be_suppressed:
                found.add(process.name)
    return frozenset(found)


@dataclass(frozen=True, slots=True)
class CoreLoad:
    """The load of a core by some processes.

    Attributes
    ----------
    demands : of the processes that count, on the core
    """

    core: str
    demands: Mapping[str, MultiframeDemand]
    activations: Activations
    demand_model: DemandModel
    _of_jobs: dict[str, JobDemand] = field(default_factory=dict)

    def load(self, rates: Mapping[str, Fraction]) -> JobDemand:
        """The load, as a share of the core.

        Parameters
        ----------
        rates : activations per picosecond of each process that no process triggers
        """
        # The processes that count, and those that trigger them, others in between included.
        causing = reached(self.demands, self.activations.triggering)
        per_time = total(self.of_job(name).every(rates[name]) for name in causing if rates.get(name))
        return per_time.every(Fraction(1, self.demand_model.time_base(self.core)))

    def of_job(self, process: str) -> JobDemand:
        """The demand of a job of a process, with all that it triggers."""
        if process not in self._of_jobs:
            self._of_jobs[process] = NOTHING  # what is triggered in a circle counts once
            self._of_jobs[process] = self._of_job(process)
        return self._of_jobs[process]

    def _of_job(self, process: str) -> JobDemand:
        demand = self.demands.get(process)
        own = NOTHING if demand is None else JobDemand.of(demand)
        triggered: dict[int, JobDemand] = {}
        for effect in self.activations.effects(process):
            activated = self.activations.activated(effect.stimulus)
            caused = total(map(self.of_job, activated)).every(effect.share)
            if caused != NOTHING:
                triggered[effect.position.number] = triggered.get(effect.position.number, NOTHING) + caused
        if not triggered:
            return own
        model = self.activations.system.processes[process]
        positions = self.activations.dataflow.events.positions(process)

        def of_activities(*activities: Activity) -> JobDemand:
            if demand is None:
                return NOTHING
            return JobDemand.of(self.demand_model.of_activities(model, activities, self.core))

        paths = JobPaths(positions, triggered, of_activities, self.demand_model.settings.modes)
        # Overheads of the operating system and copies of labels are not in the activities.
        return paths.demand() + own + of_activities(*model.activities).every(-1)


def loads(
    cores: Mapping[str, frozenset[str]], rates: Mapping[str, Fraction], demand_model: DemandModel, uncertain: Collection[str]
) -> Mapping[str, Mapping[str, Fraction]]:
    """The worst-case utilisation of its core by each process with a single core, as far as it is certain of each one alone.

    Processes with unknown demand or activation rate are left out, and what modes may exclude.

    Parameters
    ----------
    cores : on which each process can run
    rates : activations per picosecond
    uncertain : processes that may be activated less often, such as those that execute rounds of executors
    """
    found: dict[str, dict[str, Fraction]] = {}
    for core, demands in _demands(cores, demand_model, uncertain).items():
        for name in (name for name in demands if name in rates):
            share = demands[name].mean_occurring * rates[name] / demand_model.time_base(core)
            found.setdefault(core, {})[name] = share
    return found


def certain_loads(
    cores: Mapping[str, frozenset[str]], activations: Activations, demand_model: DemandModel, uncertain: Collection[str]
) -> Mapping[str, Fraction]:
    """The worst-case load of each core, as far as it is certain, by processes with a single core; see `loads`."""
    if demand_model.system is not activations.system:
        activations = Activations(demand_model.system, Dataflow(demand_model.system))
    rates: dict[str, Fraction] = {}
    for process in demand_model.system.processes.values():
        with suppress(UnknownError):
            rates[process.name] = activations.external_rate(process)
    return {
        core: CoreLoad(core, demands, activations, demand_model).load(rates).certain
        for core, demands in _demands(cores, demand_model, uncertain).items()
    }


def _demands(
    cores: Mapping[str, frozenset[str]], demand_model: DemandModel, uncertain: Collection[str]
) -> Mapping[str, Mapping[str, MultiframeDemand]]:
    """The known demands of the processes of each core that run nowhere else."""
    found: dict[str, dict[str, MultiframeDemand]] = {}
    for name, allowed in cores.items():
        process = demand_model.system.processes.get(name)
        if process is None or len(allowed) > 1 or name in uncertain:
            continue
        (core,) = allowed
        with suppress(UnknownError):
            found.setdefault(core, {})[name] = demand_model.of_process(process, core)
    return found


#: A load of ten cores is no mistake of a design.
_ABSURD_LOAD = 10
#: No controller that executes tasks is as slow: a clock below 1 kHz is one whose prefix is missing.
_SLOWEST = 1000


def unit_hint(load: Fraction | int, frequency: Frequency | None) -> str:
    """A question about the unit of a clock with which a core has an absurd load; "" for any other core."""
    if frequency is None or frequency >= _SLOWEST or load < _ABSURD_LOAD:
        return ""
    return f"its clock has {frequency_text(frequency)}: is that the unit, or kHz or MHz?"
