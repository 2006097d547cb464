"""Version without an XML schema."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.validate.rule import Rule

RULE = Rule(
    id="XSD000",
    title="version without an XML schema",
    severity=Severity.WARNING,
    rationale="The elements and attributes of the file cannot be validated, and the file is read as the nearest known version.",
    remedy="Correct the version in the namespace of the root element if it is a mistake.",
    fails="""
<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.4.0"/>
""",
    passes="""
<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0"/>
""",
)
