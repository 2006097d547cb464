"""The system with changes, and AMALTHEA models of it: of a model that was read, only the changed values differ."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING

from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.key import CLOCKS, unused
from amalthea_uros.errors import InvalidArgumentError, WriteError
from amalthea_uros.perf.hardware import Clock, Structure
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import with_stated_phases
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Frequency

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Model


def update_model(model: Model, changes: Sequence[Change], settings: Settings) -> None:
    """Change a model, and verify it: what is extracted from it is the changed system.

    Raises
    ------
    InvalidArgumentError : a change cannot be written into the model.
    """
    from amalthea_uros.bridge.extract import extract
    from amalthea_uros.bridge.update import update

    old = extract(model).system
    new = changed_system(old, changes, settings)
    try:
        update(model, old, new)
    except InvalidArgumentError as error:
        raise InvalidArgumentError(f"the change cannot be written into the model: {error}") from None
    except WriteError as error:
        reason = next((finding.message for finding in error.findings), str(error))
        raise InvalidArgumentError(f"the change cannot be written into the model: {reason}") from None
    if (found := extract(model).system) != new:
        raise InvalidArgumentError(f"the change cannot be written into the model: its {_other_part(found, new)} would differ")


def _other_part(one: System, other: System) -> str:
    """The part of two systems that is not equal."""
    for model in fields(System):
        parts = getattr(one, model.name), getattr(other, model.name)
        for part in fields(parts[0]):
            if getattr(parts[0], part.name) != getattr(parts[1], part.name):
                return f"{model.name} ({part.name.replace('_', ' ')})"
    raise AssertionError("the systems are equal")


def changed_system(system: System, changes: Sequence[Change], settings: Settings) -> System:
    """The system with the changes, also with those that are settings of an analysis."""
    changed = apply(system, settings, changes)
    stated = {change.target for change in changes}
    frequencies = {core: rate for core, rate in changed.settings.frequencies.items() if f"{core}.frequency" in stated}
    phases = {source: time for source, time in changed.settings.phases.items() if f"{source}.phase" in stated}
    for core, frequency in frequencies.items():
        changed = changed._replace(system=_with_core_frequency(changed.system, core, frequency))
    return with_stated_phases(changed.system, phases)


def _with_core_frequency(system: System, core: str, frequency: Frequency) -> System:
    """The system in which a core has another frequency; other cores with the same clock keep theirs."""
    clock = system.cores[core].clock
    if clock is not None and clock in system.clocks and _users(clock, system) == 1:
        return CLOCKS.with_fields(system, clock, frequency=frequency)
    name = unused(f"Clock of {core}", system.clocks)
    system = CLOCKS.with_item(system, Clock(name=name, frequency=frequency))
    structures = tuple(_with_clock(structure, core, name) for structure in system.hardware.structures)
    return replace(system, hardware=replace(system.hardware, structures=structures))


def _users(clock: str, system: System) -> int:
    """The number of cores and other modules that have a clock."""
    modules = (*system.cores.values(), *system.memories.values(), *system.modules.values())
    return sum(getattr(module, "clock", None) == clock for module in modules)


def _with_clock(structure: Structure, core: str, clock: str) -> Structure:
    return replace(
        structure,
        cores=tuple(replace(each, clock=clock) if each.name == core else each for each in structure.cores),
        structures=tuple(_with_clock(inner, core, clock) for inner in structure.structures),
    )
