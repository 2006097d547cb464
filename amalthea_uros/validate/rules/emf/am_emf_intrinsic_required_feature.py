"""Missing required value."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.versions import facts
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._facts import per_class, stored_features


def _check(element: Element, context: Context) -> Iterator[str]:
    values = element.__dict__
    for name, xml_name in _required(type(element), context.version_of(element)):
        if values.get(name) is None:
            yield f"the {type(element).__name__} has no {xml_name}"


@per_class
def _required(cls: type[Element], version: str) -> tuple[tuple[str, str], ...]:
    """The single features that need a value, and that have none by default, by Python and XML name."""
    declared = facts(version)
    features = stored_features(cls, version).items()
    return tuple((name, f.name) for name, f in features if f.required and not f.many and declared.default(f) is None)


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/required-feature",
    title="missing required value",
    severity=Severity.ERROR,
    target=Element,
    check=_check,
    concerns=_required,
    rationale="Other objects and the tools that read the model rely on the value. APP4MC's validation also reports it.",
    remedy="Set the value.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'xsi:type="am:RunnableCall"': 'xsi:type="am:RunnableCall" runnable="S?type=Runnable"',
        "</swModel>": """  <runnables name="S"/>
</swModel>""",
    },
)
