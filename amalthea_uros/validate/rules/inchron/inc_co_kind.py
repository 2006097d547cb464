"""Constraint or requirement that is dropped."""

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
        yield f"the {type(element).__name__} {name_of(element)!r} is dropped"


RULE = ModelRule(
    id="INC-CO-KIND",
    title="constraint or requirement that is dropped",
    severity=Severity.WARNING,
    target=_DROPPED,
    check=_check,
    rationale="am2inc drops all but latency constraints, with one warning for each class and no names.",
    remedy="Do not rely on them after the import; amuros analyze judges them.",
    fails="""
<constraintsModel>
  <requirements xsi:type="am:ProcessRequirement" name="R"/>
</constraintsModel>
""",
    passes="""
<constraintsModel/>
""",
)
