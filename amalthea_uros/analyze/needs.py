"""The execution times and loads of processes on each kind of core, where the core, or its clock, is not stated.

A job of a process takes the same time wherever it is executed on cores of one type and clock, and the long-run load that it causes
there is at most its worst execution time, times the highest rate of its activations.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import cached_property

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.analyze.results.needs import ExecutionOnCores
from amalthea_uros.perf.activities import Waiting
from amalthea_uros.perf.software import Process
from amalthea_uros.timing.activation.load import activation_rates
from amalthea_uros.timing.basics.time_base import max_time, min_time
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.alike_cores import DemandOnAnyCores, DemandOnCores
from amalthea_uros.timing.jobs.executed import states_mean
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.units import SECOND, Frequency

WITHOUT_WAITS = "without the time for which it waits for events"


@dataclass
class Needs:
    """Finds the execution times and loads of processes on each kind of core that they may run on."""

    context: TimingContext
    demands: DemandOnAnyCores = field(init=False)

    def __post_init__(self) -> None:
        self.demands = DemandOnAnyCores(self.context.demand_model)

    def of(self, name: str) -> tuple[ExecutionOnCores, ...]:
        """The execution time and the load of a process."""
        process = self.context.system.processes[name]
        has_mean = states_mean(process, self.context.system)
        on_cores = self.demands.of(process, self._cores.get(name, frozenset()))
        remark = WITHOUT_WAITS if self.demands.waits(process) else ""
        return tuple(_need(each, self._rate(process), has_mean, remark) for each in on_cores)

    @cached_property
    def _cores(self) -> Mapping[str, frozenset[str]]:
        return allocated_cores(self.context.system)

    @cached_property
    def _rates(self) -> Mapping[str, Fraction]:
        return activation_rates(self.context.system, self.context.activations)

    def _rate(self, process: Process) -> Fraction | None:
        """Activations per picosecond at most; None if it is unknown, or the jobs may execute while they wait."""
        return None if self.demands.waits(process, (None, Waiting.ACTIVE)) else self._rates.get(process.name)


def _need(demanded: DemandOnCores, rate: Fraction | None, has_mean: bool, remark: str) -> ExecutionOnCores:
    demand, on = demanded.demand, demanded.on
    if demand is None:
        return ExecutionOnCores(core_type=on.type, cores=on.cores, frequency=on.frequency, reason=demanded.reason)
    # Picoseconds or ticks per picosecond.
    load = None if rate is None else demand.mean_worst * rate / demanded.time_base
    return ExecutionOnCores(
        core_type=on.type,
        cores=on.cores,
        frequency=on.frequency,
        best=min_time(demand.best, demanded.time_base),
        mean=demand.mean / demanded.time_base if has_mean else None,
        worst=max_time(demand.worst, demanded.time_base),
        load=load if on.frequency is not None else None,
        least_frequency=None if load is None or on.frequency is not None else Frequency(load * SECOND),
        reason=remark,
    )
