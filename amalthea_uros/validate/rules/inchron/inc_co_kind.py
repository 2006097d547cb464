"""Constraint or requirement that is dropped."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    AffinityConstraint,
    DataAgeConstraint,
    EventChainLatencyConstraint,
    Requirement,
    RunnableSequencingConstraint,
    TimingConstraint,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Element, context: Context) -> Iterator[str]:
    others = isinstance(element, TimingConstraint) and not isinstance(element, EventChainLatencyConstraint)
    kinds = Requirement | AffinityConstraint | RunnableSequencingConstraint | DataAgeConstraint
    if others or isinstance(element, kinds):
        yield f"the {type(element).__name__} {getattr(element, 'name', None) or ''!r} is dropped"


RULE = ModelRule(
    id="INC-CO-KIND",
    title="constraint or requirement that is dropped",
    severity=Severity.WARNING,
    target=Element,
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
