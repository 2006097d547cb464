"""The stated distributions on which compared quantities are based."""

from __future__ import annotations

from collections.abc import Callable

from amalthea_uros.compare.measured.receptions import receptions
from amalthea_uros.compare.naming import Target
from amalthea_uros.compare.phases import systems_in_phases
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import with_first_arrivals
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.stated_distributions import Basis, StatedDistributions


def bases(system: System, settings: Settings) -> Callable[[Target], Basis]:
    """Return the basis of the distribution of each compared quantity."""
    are_phases_open = systems_in_phases(system, settings) is None
    stated = StatedDistributions(with_first_arrivals(system, settings.phases), settings, are_phases_open)

    of_host = system.host.callback_names | receptions(system.host).keys()

    def basis_of(target: Target) -> Basis:
        if target.name in of_host and target.name not in system.runnables and target.name not in system.chains:
            return Basis()  # only bounds are predicted of it
        match target.kind:
            case MeasuredKind.CHAIN:
                return stated.of_chain(target.name)
            case MeasuredKind.RUNNABLE:
                return stated.of_runnable(target.name, target.quantity)
        return stated.of_process(target.name, target.quantity)

    return basis_of
