"""Names of objects in references, for versions before 0.9.7 and for what is in no file."""

from __future__ import annotations

from amalthea_uros.metamodel.naming import TYPE_MARK, encode
from amalthea_uros.xmi.migrate.classes import class_of
from amalthea_uros.xmi.migrate.node import Node

#: Classes whose names are qualified by that of their container.
_QUALIFIED = {
    "ModeLiteral",
    "HwPort",
    "InterfacePort",
    "FInterfacePort",
    "HwFeature",
    "HwConnection",
    "ComponentInstance",
    "ComponentPort",
}


def reference_text(node: Node) -> str:
    """The text by which a reference names an object."""
    class_name = class_of(node)
    if node.is_proxy:
        path = node.attributes["path"]
    else:
        holder = node.parent.name if node.parent is not None and class_name in _QUALIFIED else ""
        path = f"{encode(holder)}/{encode(node.name)}" if holder else encode(node.name)
    if not class_name:
        return path
    # ITEA 1.3.0 qualifies the class by its package: `sw.Label`.
    return path + TYPE_MARK + class_name.replace(":", ".")
