"""Violation of the XML schema."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="XSD001",
    title="violation of the XML schema",
    severity=Severity.ERROR,
    rationale="APP4MC and downstream tools reject elements, attributes and values that the version of the file does not define.",
    remedy="Use only elements, attributes and values that the schema of this version allows.",
    fails="""
<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">
  <swModel>
    <tasks name="T" preemption="never"/>
  </swModel>
</am:Amalthea>
""",
    passes="""
<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">
  <swModel>
    <tasks name="T" preemption="non_preemptive"/>
  </swModel>
</am:Amalthea>
""",
)
