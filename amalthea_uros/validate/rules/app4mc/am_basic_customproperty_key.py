"""Duplicate custom property."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import IAnnotatable
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: IAnnotatable, context: Context) -> Iterator[str]:
    properties = element.__dict__.get("custom_properties", ())
    if len(properties) < 2:
        return
    for key, times in Counter(entry.key for entry in properties).items():
        if times > 1:
            yield f"custom property {key!r} is defined {times} times"


RULE = ModelRule(
    id="AM-Basic-CustomProperty-Key",
    title="duplicate custom property",
    severity=Severity.WARNING,
    target=IAnnotatable,
    check=_check,
    rationale="Only one of the values takes effect, and which one is undefined. APP4MC's validation also reports it.",
    remedy="Define each key only once.",
    fails="""
<swModel>
  <tasks name="T">
    <customProperties key="k">
      <value xsi:type="am:StringObject" value="1"/>
    </customProperties>
    <customProperties key="k">
      <value xsi:type="am:StringObject" value="2"/>
    </customProperties>
  </tasks>
</swModel>
""",
    edits={
        """    <customProperties key="k">
      <value xsi:type="am:StringObject" value="2"/>
    </customProperties>
""": "",
    },
)
