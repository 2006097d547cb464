"""The generic performance model as an AMALTHEA model."""

from __future__ import annotations

from typing import Any

from amalthea_uros.bridge.basics.context import Building
from amalthea_uros.bridge.tables.constraints import build_data_group, build_requirement
from amalthea_uros.bridge.tables.hardware import HardwareBuilder
from amalthea_uros.bridge.tables.mapping import build_mapping
from amalthea_uros.bridge.tables.middleware import build_middleware
from amalthea_uros.bridge.tables.objects import OBJECTS
from amalthea_uros.bridge.tables.os import build_overhead, build_system, fill_system
from amalthea_uros.bridge.tables.parameters import SchedulingDefinitions
from amalthea_uros.bridge.tables.software import build_modes
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.versions import newest_version
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
    root = _build_root(system, context)
    context.finish()
    model = Model.of(root, context.version)
    model.documents[0].origins = context.origins
    return model


def _build_root(system: System, context: Building) -> am.Amalthea:
    """The whole model without empty sub-models: first all objects, so that references find them, and then their features."""
    definitions = SchedulingDefinitions(context)
    hardware, os_model, software = HardwareBuilder(context).build(system.hardware), am.OSModel(), am.SWModel()
    stimuli, events, constraints = am.StimuliModel(), am.EventModel(), am.ConstraintsModel()
    models: dict[type, Any] = {type(model): model for model in (os_model, software, stimuli, events, constraints)}
    waiting = []
    for part, field, model_class, feature, table in OBJECTS:
        items = getattr(getattr(system, part), field)
        elements = table.create_all(items, context)
        setattr(models[model_class], feature, elements)
        waiting.append((table, elements, items))
    software.modes = build_modes(system.software.modes, context)
    os_model.operating_systems = [build_system(each, context) for each in system.os.systems]
    os_model.os_overheads = [am.OsOverhead(name=overhead.name) for overhead in system.os.overheads]
    for overhead, cost in zip(system.os.overheads, os_model.os_overheads, strict=True):
        context.register(overhead, cost)
    for each, element in zip(system.os.systems, os_model.operating_systems, strict=True):
        fill_system(each, element, definitions)
    for overhead, cost in zip(system.os.overheads, os_model.os_overheads, strict=True):
        build_overhead(overhead, cost, context)
    for table, elements, items in waiting:
        table.fill(elements, items, context)
    build_middleware(system, software, context)
    mapping = build_mapping(system, definitions)
    os_model.scheduler_definitions = list(definitions.schedulers.values())
    os_model.scheduling_parameter_definitions = list(definitions.parameters.values())
    types: Any = list(context.types.values())
    software.type_definitions = types
    constraints.requirements = [build_requirement(requirement, context) for requirement in system.constraints.requirements]
    for group in system.constraints.data_groups:
        built = build_data_group(group, context)
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


def _unless_empty(model: Any) -> Any:
    return model if any(True for _ in model.contents()) else None
