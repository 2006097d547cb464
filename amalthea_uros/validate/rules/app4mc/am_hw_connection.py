"""Connection whose ends do not fit."""

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
            yield f"the connection {element.name!r} has no {name}"
    if first is None or second is None:
        return
    if first is second:
        yield f"the connection {element.name!r} joins a port with itself"
    elif not is_internal(element):
        interfaces = {first.port_interface, second.port_interface} - {None, PortInterface.UNDEFINED}
        if len(interfaces) > 1:
            yield f"the connection {element.name!r} joins ports of the interfaces {' and '.join(sorted(map(str, interfaces)))}"


RULE = ModelRule(
    id="AM-HW-Connection",
    title="connection whose ends do not fit",
    severity=Severity.ERROR,
    target=HwConnection,
    check=_check,
    rationale="It joins nothing, or what cannot be joined. APP4MC reports it when it validates the model.",
    remedy="Join two different ports of the same interface.",
    fails="""
<hwModel>
  <structures name="ECU">
    <connections name="wire"/>
  </structures>
</hwModel>
""",
    passes="""
<hwModel>
  <structures name="ECU">
    <ports name="a" portInterface="AXI"/>
    <ports name="b" portInterface="AXI"/>
    <connections name="wire" port1="ECU/a?type=HwPort" port2="ECU/b?type=HwPort"/>
  </structures>
</hwModel>
""",
)
