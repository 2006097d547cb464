"""Hardware features of the same category."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ProcessingUnitDefinition
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.app4mc._features import shared_categories


def _check(element: ProcessingUnitDefinition, context: Context) -> Iterator[str]:
    for features in shared_categories(element).values():
        for feature in features:
            yield f"feature {feature.name!r} is not the only feature of its category in {element.name!r}"


RULE = ModelRule(
    id="AM-HW-Definition",
    title="hardware features of the same category",
    severity=Severity.ERROR,
    target=ProcessingUnitDefinition,
    check=_check,
    rationale="Execution needs select a feature by its category; with several features the selection is ambiguous. APP4MC's "
    "validation also reports it.",
    remedy="Refer to only one feature of each category.",
    fails="""
<hwModel>
  <definitions xsi:type="am:ProcessingUnitDefinition" name="D" features="I/a?type=HwFeature I/b?type=HwFeature"/>
  <featureCategories name="I">
    <features name="a"/>
    <features name="b"/>
  </featureCategories>
</hwModel>
""",
    edits={
        'features="I/a?type=HwFeature I/b?type=HwFeature"': 'features="I/a?type=HwFeature"',
        '    <features name="b"/>\n': "",
    },
)
