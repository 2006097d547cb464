"""Connection between incompatible ports."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import HwConnection, HwPort, HwStructure, PortType, ProcessingUnit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

_TYPES = (PortType.INITIATOR, PortType.RESPONDER)


def _check(element: HwConnection, context: Context) -> Iterator[str]:
    structure, first, second = element.container, element.port1, element.port2
    if not isinstance(structure, HwStructure) or first is None or second is None or first is second:
        return
    if not {first.port_type, second.port_type}.issubset(_TYPES):
        return
    outer = {_is_outer(first, structure), _is_outer(second, structure)}
    if outer == {True, False} and first.port_type != second.port_type:
        yield f"connection {element.name!r} delegates between ports of type {first.port_type} and {second.port_type}"
    elif outer in ({True}, {False}) and first.port_type == second.port_type:
        yield f"connection {element.name!r} connects two ports of type {first.port_type}"


def _is_outer(port: HwPort, structure: HwStructure) -> bool | None:
    """True for a port of the structure itself, False for a port of its direct parts, None for any other port."""
    holder = port.container
    if holder is structure:
        return True
    if holder is not None and isinstance(holder.container, ProcessingUnit):
        holder = holder.container  # the port belongs to a cache
    return False if holder is not None and holder.container is structure else None


RULE = ModelRule(
    id="AM-HW-Structure",
    title="connection between incompatible ports",
    severity=Severity.ERROR,
    target=HwConnection,
    check=_check,
    rationale="A connection links an initiator to a responder; a port of a structure delegates to an inner port of the same "
    "type. APP4MC's validation also reports it.",
    remedy="Connect an initiator to a responder, and delegate ports of a structure to inner ports of the same type.",
    fails="""
<hwModel>
  <structures name="ECU">
    <modules xsi:type="am:ProcessingUnit" name="core">
      <ports name="p" portType="initiator"/>
    </modules>
    <modules xsi:type="am:Memory" name="RAM">
      <ports name="p" portType="initiator"/>
    </modules>
    <connections name="wire" port1="core/p?type=HwPort" port2="RAM/p?type=HwPort"/>
  </structures>
</hwModel>
""",
    edits={
        """<modules xsi:type="am:Memory" name="RAM">
      <ports name="p" portType="initiator"/>""": """<modules xsi:type="am:Memory" name="RAM">
      <ports name="p" portType="responder"/>""",
    },
)
