"""What rules may ask of a system, found once for all of them; the answers come from `timing`."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import cached_property

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.activations import Activations
from amalthea_uros.timing.activation.load import activation_rates, certain_loads, loads, suppressible
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.demand.model import DemandModel
from amalthea_uros.timing.scheduling.allocation import allocated_cores, controller_of_core
from amalthea_uros.timing.touching import with_successors


@dataclass
class SystemContext:
    """A system with what is known of it."""

    system: System

    @cached_property
    def dataflow(self) -> Dataflow:
        """Where jobs do what, and what links them."""
        return Dataflow(self.system)

    @cached_property
    def cores(self) -> Mapping[str, frozenset[str]]:
        """The cores on which each process may run."""
        return allocated_cores(self.system)

    @cached_property
    def controllers(self) -> Mapping[str, str]:
        """The controller of each core."""
        return controller_of_core(self.system)

    @cached_property
    def activations(self) -> Activations:
        """The activations of all processes."""
        return Activations(self.system, self.dataflow)

    @cached_property
    def rates(self) -> Mapping[str, Fraction]:
        """Maximum number of activations per picosecond of each process."""
        return activation_rates(self.system, self.activations)

    @cached_property
    def loads(self) -> Mapping[str, Mapping[str, Fraction]]:
        """The share of each core that each of its processes demands in the worst case."""
        return loads(self.cores, self.rates, self._demand_model, self._uncertain)

    @cached_property
    def certain_loads(self) -> Mapping[str, Fraction]:
        """The share of each core that its processes demand together in the worst case."""
        return certain_loads(self.cores, self.activations, self._demand_model, self._uncertain)

    @cached_property
    def _demand_model(self) -> DemandModel:
        return DemandModel(self.system, AnalysisNotes())

    @cached_property
    def _uncertain(self) -> frozenset[str]:
        """The processes that may be activated less often than their event models say."""
        return with_successors(self.system.executor_of_task, self.system, self.dataflow) | suppressible(
            self.system, self.activations
        )
