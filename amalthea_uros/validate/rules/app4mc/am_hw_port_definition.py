"""Port without a type or interface."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwPort
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: HwPort, context: Context) -> Iterator[str]:
    for feature in ("port_type", "port_interface"):
        if getattr(element, feature) in (None, "_undefined_"):
            yield f"port {element.name!r} has no {feature.replace('_', ' ')}"


RULE = ModelRule(
    id="AM-HW-Port-Definition",
    title="port without a type or interface",
    severity=Severity.WARNING,
    target=HwPort,
    check=_check,
    rationale="Without a type and an interface, connections to the port cannot be checked. APP4MC's validation also reports it.",
    remedy="Set the port type and the port interface.",
    fails="""
<hwModel>
  <structures name="ECU">
    <ports name="a"/>
  </structures>
</hwModel>
""",
    edits={'name="a"': 'name="a" portType="initiator" portInterface="AXI"'},
)
