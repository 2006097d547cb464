"""Invalid hardware connection."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwConnection, PortInterface
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.app4mc._hardware import is_internal


def _check(element: HwConnection, context: Context) -> Iterator[str]:
    first, second = element.port1, element.port2
    for name, port in (("port1", first), ("port2", second)):
        if port is None:
            yield f"connection {element.name!r} has no {name}"
    if first is None or second is None:
        return
    if first is second:
        yield f"connection {element.name!r} connects a port to itself"
    elif not is_internal(element):
        interfaces = {first.port_interface, second.port_interface} - {None, PortInterface.UNDEFINED}
        if len(interfaces) > 1:
            yield f"connection {element.name!r} connects different interfaces: {' and '.join(sorted(map(str, interfaces)))}"


RULE = ModelRule(
    id="AM-HW-Connection",
    title="invalid hardware connection",
    severity=Severity.ERROR,
    target=HwConnection,
    check=_check,
    rationale="No data can be transferred over such a connection. APP4MC's validation also reports it.",
    remedy="Connect two different ports with the same interface.",
    fails="""
<hwModel>
  <structures name="ECU">
    <connections name="wire"/>
  </structures>
</hwModel>
""",
    edits={
        '<connections name="wire"/>': """<ports name="a" portInterface="AXI"/>
    <ports name="b" portInterface="AXI"/>
    <connections name="wire" port1="ECU/a?type=HwPort" port2="ECU/b?type=HwPort"/>""",
    },
)
