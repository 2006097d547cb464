"""Port without a type or an interface."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwPort
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwPort, context: Context) -> Iterator[str]:
    for feature in ("port_type", "port_interface"):
        if getattr(element, feature) in (None, "_undefined_"):
            yield f"the {feature.replace('_', ' ')} of {element.name!r} is not stated"


RULE = ModelRule(
    id="AM-HW-Port-Definition",
    title="port without a type or an interface",
    severity=Severity.WARNING,
    target=HwPort,
    check=_check,
    rationale="It is not known what can be joined to it. APP4MC reports it when it validates the model.",
    remedy="State both.",
    fails="""
<hwModel>
  <structures name="ECU">
    <ports name="a"/>
  </structures>
</hwModel>
""",
    passes="""
<hwModel>
  <structures name="ECU">
    <ports name="a" portType="initiator" portInterface="AXI"/>
  </structures>
</hwModel>
""",
)
