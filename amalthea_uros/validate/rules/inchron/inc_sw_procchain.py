"""Unsupported object."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    Channel,
    Component,
    CoreAllocationConstraint,
    CustomEntity,
    IAnnotatable,
    MemoryMappingConstraint,
    ProcessChain,
    ProcessPrototype,
    Scenario,
    Section,
    System,
)
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

_IGNORED = (
    ProcessChain,
    ProcessPrototype,
    Section,
    CustomEntity,
    Channel,
    Scenario,
    Component,
    System,
    CoreAllocationConstraint,
    MemoryMappingConstraint,
)


def _check(element: IAnnotatable, context: Context) -> Iterator[str]:
    yield f"the {type(element).__name__} {name_of(element)!r} is ignored by am2inc"


RULE = ModelRule(
    id="INC-SW-PROCCHAIN",
    title="unsupported object",
    severity=Severity.WARNING,
    target=_IGNORED,
    check=_check,
    rationale="am2inc silently ignores process chains, process prototypes, sections, custom entities, channels, scenarios, "
    "components, component systems and property constraints.",
    remedy="Remove the object, or do not rely on it after the import.",
    fails="""
<swModel>
  <processChains name="C"/>
</swModel>
""",
    passes="""
<swModel/>
""",
)
