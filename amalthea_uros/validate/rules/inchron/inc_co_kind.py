"""Unsupported constraint or requirement."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    AffinityConstraint,
    DataAgeConstraint,
    DataCoherencyGroup,
    DataStabilityGroup,
    EventChainLatencyConstraint,
    IAnnotatable,
    PhysicalSectionConstraint,
    Requirement,
    RunnableSequencingConstraint,
    TimingConstraint,
)
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

_DROPPED = (
    TimingConstraint,
    AffinityConstraint,
    RunnableSequencingConstraint,
    DataAgeConstraint,
    DataCoherencyGroup,
    DataStabilityGroup,
    PhysicalSectionConstraint,
    Requirement,
)


def _check(element: IAnnotatable, context: Context) -> Iterator[str]:
    if not isinstance(element, EventChainLatencyConstraint):
        yield f"the {type(element).__name__} {name_of(element)!r} is dropped by am2inc"


RULE = ModelRule(
    id="INC-CO-KIND",
    title="unsupported constraint or requirement",
    severity=Severity.WARNING,
    target=_DROPPED,
    check=_check,
    rationale="am2inc converts only latency constraints of event chains. It drops all other constraints and all requirements, "
    "and prints one warning per class without the names of the objects.",
    remedy="Check timing requirements with amuros analyze, or enter them by hand after the import.",
    fails="""
<constraintsModel>
  <requirements xsi:type="am:ProcessRequirement" name="R"/>
</constraintsModel>
""",
    passes="""
<constraintsModel/>
""",
)
