"""Ports of hardware objects."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.hardware.tools import Shape, keep_reference
from amalthea_uros.xmi.migrate.steps.properties import add_property

_ATTRIBUTES = frozenset({"bitWidth", "portType", "priority", "portInterface"})
_PORT = Shape("ports", _ATTRIBUTES)
_INITIATOR = Shape("initiator ports", _ATTRIBUTES)

#: What is worth a custom property, where it says something. Addresses and cycles belong to what answers an access.
_KEPT = ("direction", "schedValue")
_KEPT_OF_RESPONDERS = ("readCycles", "writeCycles", "baseAddress", "addressRange", *_KEPT)
_NOTHING = frozenset({"", "_undefined_", "0", "0x0"})


def convert_ports(node: Node, notes: Notes) -> None:
    """Convert the ports of a structure or module."""
    for port in node.all("ports"):
        port.type, port.target_class = "", "HwPort"
        master = port.attributes.pop("master", None)
        is_initiator = master is not None and master.strip().lower() == "true"
        if master is not None:
            port.attributes["portType"] = "initiator" if is_initiator else "responder"
            notes.converted(port, "'master' of ports -> 'portType'", f"{master} -> {port.get('portType')}", "master")
        _keep(port, _KEPT if is_initiator else _KEPT_OF_RESPONDERS, notes)
        (_INITIATOR if is_initiator else _PORT).reduce(port, notes)


def _keep(port: Node, names: tuple[str, ...], notes: Notes) -> None:
    for name in names:
        text = port.attributes.pop(name, "")
        # An address of 0 means something if there is a range.
        if text not in _NOTHING or (name == "baseAddress" and text and port.get("addressRange") not in _NOTHING):
            add_property(port, name, text)
            notes.kept(port, f"{name!r} of ports", text, name)
    network = port.references.pop("network", [])
    if network:
        keep_reference(port, "network", network)
        notes.kept(port, "'network' of ports", network[0].name, "network")
