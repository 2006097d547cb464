"""Feature of a hardware type."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwFeature
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwFeature, context: Context) -> Iterator[str]:
    yield f"the feature {element.name!r} is ignored"


RULE = ModelRule(
    id="INC-HW-FEATURE",
    title="feature of a hardware type",
    severity=Severity.WARNING,
    target=HwFeature,
    check=_check,
    rationale="am2inc ignores features, also those from which execution times follow, without a word.",
    remedy="State execution times as Ticks.",
    fails="""
<hwModel>
  <featureCategories name="Instructions">
    <features name="IPC" value="1.5"/>
  </featureCategories>
</hwModel>
""",
    passes="""
<hwModel/>
""",
)
