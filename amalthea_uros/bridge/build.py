"""The generic performance model as an AMALTHEA model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from amalthea_uros.bridge.basics.context import Building
from amalthea_uros.bridge.basics.entries import ClassTable
from amalthea_uros.bridge.tables.constraints import CONSTRAINTS, DATA_AGES, ORDERS, build_data_group, build_requirement
from amalthea_uros.bridge.tables.events import CHAINS, EVENTS
from amalthea_uros.bridge.tables.hardware import HardwareBuilder
from amalthea_uros.bridge.tables.mapping import build_mapping
from amalthea_uros.bridge.tables.middleware import build_middleware
from amalthea_uros.bridge.tables.os import SEMAPHORES, build_overhead, build_system, fill_system
from amalthea_uros.bridge.tables.parameters import SchedulingDefinitions
from amalthea_uros.bridge.tables.software import CHANNELS, LABELS, MODE_LABELS, OS_EVENTS, PROCESSES, RUNNABLES, build_modes
from amalthea_uros.bridge.tables.stimuli import CLOCKS, STIMULI
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.versions import newest_version
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.system import System


def build_model(system: System, version: str | None = None) -> Model:
    """The AMALTHEA model of a system.

    Parameters
    ----------
    version : AMALTHEA version, from 1.2.0 on; the newest one if none is given

    Raises
    ------
    WriteError : an undefined or duplicate name, or something that the version cannot represent. Classes, features and literals
        that the version does not have are refused when the model is written.
    """
    context = Building(version or newest_version())
    root = _ModelBuilder(system, context).root()
    context.finish()
    model = Model.of(root, context.version)
    model.documents[0].origins = context.origins
    return model


class _ModelBuilder:
    """Creates all objects first, so that references find them, and then sets their features."""

    def __init__(self, system: System, context: Building) -> None:
        self.system = system
        self.context = context
        self.definitions = SchedulingDefinitions(context)
        self._waiting: list[tuple[ClassTable, list[Element], Sequence[Named]]] = []

    def objects(self, table: ClassTable, items: Sequence[Named]) -> Any:
        """Objects whose features are set when all objects exist."""
        elements = table.create_all(items, self.context)
        self._waiting.append((table, elements, items))
        return elements

    def root(self) -> am.Amalthea:
        """The whole model without empty sub-models."""
        hardware = HardwareBuilder(self.context).build(self.system.hardware)
        os_model = self.os_model()
        software, stimuli, events = self.software(), self.stimuli(), self.events()
        constraints = self.constraints()
        for system, element in zip(self.system.os.systems, os_model.operating_systems, strict=True):
            fill_system(system, element, self.definitions)
        for overhead, cost in zip(self.system.os.overheads, os_model.os_overheads, strict=True):
            build_overhead(overhead, cost, self.context)
        for table, elements, items in self._waiting:
            table.fill(elements, items, self.context)
        build_middleware(self.system, software, self.context)
        mapping = build_mapping(self.system, self.definitions)
        os_model.scheduler_definitions = list(self.definitions.schedulers.values())
        os_model.scheduling_parameter_definitions = list(self.definitions.parameters.values())
        types: Any = list(self.context.types.values())
        software.type_definitions = types
        requirements = self.system.constraints.requirements
        constraints.requirements = [build_requirement(requirement, self.context) for requirement in requirements]
        for group in self.system.constraints.data_groups:
            built = build_data_group(group, self.context)
            if isinstance(built, am.DataStabilityGroup):
                constraints.data_stability_groups.append(built)
            else:
                constraints.data_coherency_groups.append(built)
        return am.Amalthea(
            sw_model=_unless_empty(software),
            hw_model=_unless_empty(hardware),
            os_model=_unless_empty(os_model),
            stimuli_model=_unless_empty(stimuli),
            event_model=_unless_empty(events),
            constraints_model=_unless_empty(constraints),
            mapping_model=_unless_empty(mapping),
        )

    def os_model(self) -> am.OSModel:
        """Operating systems, their overheads, and semaphores."""
        os = self.system.os
        overheads = [am.OsOverhead(name=overhead.name) for overhead in os.overheads]
        for overhead, element in zip(os.overheads, overheads, strict=True):
            self.context.register(overhead, element)
        return am.OSModel(
            semaphores=self.objects(SEMAPHORES, os.semaphores),
            operating_systems=[build_system(system, self.context) for system in os.systems],
            os_overheads=overheads,
        )

    def software(self) -> am.SWModel:
        """Processes, functions and data."""
        software = self.system.software
        modes = build_modes(software.modes, self.context)
        return am.SWModel(
            tasks=self.objects(PROCESSES, software.tasks),
            isrs=self.objects(PROCESSES, software.isrs),
            runnables=self.objects(RUNNABLES, software.runnables),
            labels=self.objects(LABELS, software.labels),
            channels=self.objects(CHANNELS, software.channels),
            events=self.objects(OS_EVENTS, software.os_events),
            modes=modes,
            mode_labels=self.objects(MODE_LABELS, software.mode_labels),
        )

    def stimuli(self) -> am.StimuliModel:
        """Stimuli and their clocks."""
        stimuli = self.system.stimuli
        return am.StimuliModel(stimuli=self.objects(STIMULI, stimuli.stimuli), clocks=self.objects(CLOCKS, stimuli.clocks))

    def events(self) -> am.EventModel:
        """Events; their chains belong to the constraints."""
        return am.EventModel(events=self.objects(EVENTS, self.system.events.events))

    def constraints(self) -> am.ConstraintsModel:
        """Event chains and constraints."""
        stated = self.system.constraints
        return am.ConstraintsModel(
            event_chains=self.objects(CHAINS, self.system.events.chains),
            timing_constraints=self.objects(CONSTRAINTS, stated.constraints),
            data_age_constraints=self.objects(DATA_AGES, stated.data_ages),
            runnable_sequencing_constraints=self.objects(ORDERS, stated.orders),
        )


def _unless_empty(model: Any) -> Any:
    return model if any(True for _ in model.contents()) else None
