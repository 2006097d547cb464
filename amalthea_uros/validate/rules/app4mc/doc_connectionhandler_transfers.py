"""More concurrent transfers than ports."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ConnectionHandler, ConnectionHandlerDefinition, PortType
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

_TYPES = (PortType.INITIATOR, PortType.RESPONDER)


def _check(element: ConnectionHandlerDefinition, context: Context) -> Iterator[str]:
    transfers = element.max_concurrent_transfers
    for handler in context.once(_handlers).get(element, []):
        count = Counter(port.port_type for port in handler.ports)
        if transfers is not None and handler.ports and count.keys() <= set(_TYPES):
            fewest = min(_TYPES, key=count.__getitem__)
            if transfers > count[fewest]:
                ports = counted(count[fewest], f"{fewest} port")
                yield f"{handler.name!r} has {ports}, too few for {counted(transfers, 'concurrent transfer')}"


def _handlers(context: Context) -> dict[ConnectionHandlerDefinition, list[ConnectionHandler]]:
    found: dict[ConnectionHandlerDefinition, list[ConnectionHandler]] = {}
    for handler in context.all(ConnectionHandler):
        if handler.definition is not None:
            found.setdefault(handler.definition, []).append(handler)
    return found


RULE = ModelRule(
    id="DOC-ConnectionHandler-Transfers",
    title="more concurrent transfers than ports",
    severity=Severity.ERROR,
    target=ConnectionHandlerDefinition,
    check=_check,
    rationale="Each transfer needs one initiator port and one responder port. The APP4MC documentation requires enough ports "
    "of both types.",
    remedy="Reduce the number of concurrent transfers, or add ports.",
    fails="""
<hwModel>
  <definitions xsi:type="am:ConnectionHandlerDefinition" name="D" maxConcurrentTransfers="2"/>
  <structures name="ECU">
    <modules xsi:type="am:ConnectionHandler" name="bus" definition="D?type=ConnectionHandlerDefinition">
      <ports name="a" portType="responder"/>
      <ports name="b" portType="responder"/>
      <ports name="c" portType="initiator"/>
    </modules>
  </structures>
</hwModel>
""",
    edits={'maxConcurrentTransfers="2"': 'maxConcurrentTransfers="1"'},
)
