"""An AMALTHEA model as the generic performance model.

Models of any origin and version are accepted: what is missing, unresolved, or not representable in the generic performance model
becomes a finding, and the rest is extracted.
"""

from __future__ import annotations

from collections import defaultdict
from typing import Any, TypeVar

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.bridge.basics.context import Extracting
from amalthea_uros.bridge.tables.constraints import extract_data_group, extract_requirement
from amalthea_uros.bridge.tables.hardware import HardwareExtractor
from amalthea_uros.bridge.tables.mapping import extract_mapping
from amalthea_uros.bridge.tables.middleware import (
    extract_executors,
    extract_host,
    extract_network,
    without_unreadable,
)
from amalthea_uros.bridge.tables.objects import OBJECTS
from amalthea_uros.bridge.tables.os import extract_overhead, extract_system
from amalthea_uros.bridge.tables.software import extract_modes
from amalthea_uros.diagnostics import Finding
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.perf.constraints import Constraints
from amalthea_uros.perf.events import Events
from amalthea_uros.perf.hardware import Hardware
from amalthea_uros.perf.mapping import Mapping
from amalthea_uros.perf.os import Os
from amalthea_uros.perf.software import Software
from amalthea_uros.perf.stimuli import Custom, Stimuli
from amalthea_uros.perf.system import System

E = TypeVar("E", bound=Element)


@dataclass(frozen=True, slots=True, kw_only=True)
class Extraction:
    """The result of an extraction.

    Attributes
    ----------
    findings : what could not be extracted, each with its location
    """

    system: System
    findings: tuple[Finding, ...]


def extract(model: Model) -> Extraction:
    """The system that a model describes."""
    dropped: frozenset[Element] = frozenset()
    with paused_garbage_collection():
        while True:
            context = Extracting(model, dropped)
            context.name()
            system = _Extract(model, context).system()
            if context.dropped == dropped:
                return Extraction(system=system, findings=context.finish())
            # References to objects that were left out must be ignored, too.
            dropped = frozenset(context.dropped)


class _Extract:
    def __init__(self, model: Model, context: Extracting) -> None:
        self.model = model
        self.context = context

    def sub_models(self, cls: type[E]) -> list[E]:
        """The sub-models of a class, of all files."""
        parts = (part for document in self.model.documents for part in document.root.contents())
        return [part for part in parts if isinstance(part, cls)]

    def parts(self, cls: type[E], feature: str) -> list[Any]:
        """What a feature holds in the sub-models of a class, of all files."""
        return [item for part in self.sub_models(cls) for item in getattr(part, feature)]

    def objects(self, part: str) -> dict[str, tuple[Any, ...]]:
        """The objects of a part of the system that a table alone converts, by field."""
        lists = (each for each in OBJECTS if each.part == part)
        return {each.field: each.table.extract_all(self.parts(each.model_class, each.feature), self.context) for each in lists}

    def leave_out(self, cls: type[Element], *features: str) -> None:
        """Report what features of the sub-models of a class hold as not used."""
        for feature in features:
            for element in self.parts(cls, feature):
                self.context.leave_out(element)

    def system(self) -> System:
        """The whole."""
        software = self.software()
        system = System(
            hardware=self.hardware(),
            os=self.os(),
            stimuli=self.stimuli(),
            software=software,
            mapping=self.mapping(),
            events=Events(**self.objects("events")),
            constraints=self.constraints(),
        )
        return self.with_middleware(system)

    def with_middleware(self, system: System) -> System:
        """The system with its executors and its network; what is said of them in vain makes the activation of its task unknown.

        What is said of the whole network in vain can be about any task.
        """
        context, tasks = self.context, self.parts(am.SWModel, "tasks")
        system = replace(
            system,
            executors=extract_executors(tasks, system, context),
            network=extract_network(self.sub_models(am.SWModel), tasks, system, context),
            host=extract_host(self.sub_models(am.SWModel), context),
        )
        return without_unreadable(system, tasks, self.sub_models(am.SWModel), context)

    def hardware(self) -> Hardware:
        """The hardware of all files."""
        found = [HardwareExtractor(self.context).extract(model) for model in self.sub_models(am.HWModel)]
        return Hardware(
            clocks=tuple(clock for hardware in found for clock in hardware.clocks),
            core_types=tuple(core_type for hardware in found for core_type in hardware.core_types),
            structures=tuple(structure for hardware in found for structure in hardware.structures),
        )

    def os(self) -> Os:
        """The operating systems of all files."""
        context = self.context
        allocations: dict[am.Scheduler | None, list[am.SchedulerAllocation]] = defaultdict(list)
        for allocation in self.parts(am.MappingModel, "scheduler_allocation"):
            allocations[allocation.scheduler].append(allocation)
        return Os(
            systems=tuple(
                extract_system(system, allocations, context) for system in self.parts(am.OSModel, "operating_systems")
            ),
            overheads=tuple(extract_overhead(overhead, context) for overhead in self.parts(am.OSModel, "os_overheads")),
            **self.objects("os"),
        )

    def stimuli(self) -> Stimuli:
        """The stimuli of all files, and those that processes refer to in vain."""
        found = Stimuli(**self.objects("stimuli"))
        unresolved = (Custom(name=name, description="not part of the model") for name in self.context.unresolved_stimuli)
        return replace(found, stimuli=(*found.stimuli, *unresolved))

    def software(self) -> Software:
        """The software of all files."""
        self.leave_out(am.SWModel, "process_prototypes", "custom_entities", "process_chains")
        return Software(**self.objects("software"), modes=extract_modes(self.parts(am.SWModel, "modes"), self.context))

    def mapping(self) -> Mapping:
        """The mapping of all files."""
        found = [extract_mapping(mapping, self.context) for mapping in self.sub_models(am.MappingModel)]
        return Mapping(
            tasks=tuple(item for mapping in found for item in mapping.tasks),
            isrs=tuple(item for mapping in found for item in mapping.isrs),
            placements=tuple(item for mapping in found for item in mapping.placements),
        )

    def constraints(self) -> Constraints:
        """The constraints and requirements of all files."""
        context, parts = self.context, self.parts
        self.leave_out(am.ConstraintsModel, "affinity_constraints", "physical_section_constraints")
        requirements = (extract_requirement(r, context) for r in parts(am.ConstraintsModel, "requirements"))
        return Constraints(
            **self.objects("constraints"),
            data_groups=tuple(
                extract_data_group(group, context)
                for feature in ("data_coherency_groups", "data_stability_groups")
                for group in parts(am.ConstraintsModel, feature)
            ),
            requirements=tuple(requirement for requirement in requirements if requirement is not None),
        )
