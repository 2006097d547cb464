"""Lower bounds of the worst-case load of cores."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import suppress
from fractions import Fraction

from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation import Activations, UnknownActivationError
from amalthea_uros.timing.demand import DemandModel
from amalthea_uros.timing.notes import UnknownDemandError


def activation_rates(system: System, activations: Activations) -> Mapping[str, Fraction]:
    """Maximum number of activations per picosecond of each process, in the long run; processes without a bound are left out."""
    found: dict[str, Fraction] = {}
    for process in system.processes.values():
        try:
            found[process.name] = activations.of(process).rate
        except UnknownActivationError:
            continue
    return found


def suppressible(system: System, activations: Activations) -> frozenset[str]:
    """The processes of which conditions of stimuli may suppress activations."""
    found = set()
    for process in system.processes.values():
        with suppress(UnknownActivationError):
            if activations.of(process).can_be_suppressed:
                found.add(process.name)
    return frozenset(found)


def loads(
    cores: Mapping[str, frozenset[str]], rates: Mapping[str, Fraction], demand_model: DemandModel, uncertain: Collection[str]
) -> Mapping[str, Mapping[str, Fraction]]:
    """The worst-case utilisation of its core by each process with a single core, as far as it is certain.

    Processes with unknown demand or activation rate are left out, and what modes may exclude, so that the load is at least the sum.

    Parameters
    ----------
    cores : on which each process can run
    rates : activations per picosecond
    uncertain : processes that may be activated less often, such as those that execute rounds of executors
    """
    found: dict[str, dict[str, Fraction]] = {}
    for name, allowed in cores.items():
        process = demand_model.system.processes.get(name)
        if process is None or name not in rates or len(allowed) > 1 or name in uncertain:
            continue
        (core,) = allowed
        try:
            demand = demand_model.of_process(process, core)
        except UnknownDemandError:
            continue
        found.setdefault(core, {})[name] = demand.mean_occurring * rates[name] / demand_model.time_base(core)
    return found
