"""Transmit ratio outside the range 0 to 1."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TransmissionPolicy
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: TransmissionPolicy, context: Context) -> Iterator[str]:
    if element.transmit_ratio is not None and not 0 <= element.transmit_ratio <= 1:
        yield f"the transmit ratio is {element.transmit_ratio}, but must be from 0 to 1"


RULE = ModelRule(
    id="DOC-Transmission-Ratio",
    title="transmit ratio outside the range 0 to 1",
    severity=Severity.ERROR,
    target=TransmissionPolicy,
    check=_check,
    rationale="The ratio is a fraction, not a percentage. The APP4MC documentation requires a value from 0 to 1.",
    remedy="Set the transmit ratio to a value from 0 to 1.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:LabelAccess" access="read" data="L?type=Label">
        <transmissionPolicy transmitRatio="50.0"/>
      </items>
    </activityGraph>
  </runnables>
  <labels name="L"/>
</swModel>
""",
    edits={'transmitRatio="50.0"': 'transmitRatio="0.5"'},
)
