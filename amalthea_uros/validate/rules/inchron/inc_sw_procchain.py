"""Object that is ignored."""

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
    yield f"the {type(element).__name__} {name_of(element)!r} is ignored"


RULE = ModelRule(
    id="INC-SW-PROCCHAIN",
    title="object that is ignored",
    severity=Severity.WARNING,
    target=_IGNORED,
    check=_check,
    rationale="am2inc passes over process chains, sections, components and the like without a word.",
    remedy="Do not rely on it after the import.",
    fails="""
<swModel>
  <processChains name="C"/>
</swModel>
""",
    passes="""
<swModel/>
""",
)
