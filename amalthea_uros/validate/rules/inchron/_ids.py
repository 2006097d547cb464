"""How am2inc resolves references: by `xmi:id`, or else by computed names without namespaces."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import INamespaceMember
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.naming import TYPE_MARK, encode, name_of
from amalthea_uros.metamodel.source import attributes_of_tag
from amalthea_uros.validate.context import Context


def has_id(element: Element) -> bool:
    """Whether an object has an `xmi:id` in its file. An object that was not read from a file will be written with one."""
    document = element.document
    source = document.source if document is not None else None
    place = source.index.get(element) if source is not None else None
    if source is None or place is None:
        return True
    return any(attribute["name"] == source.prefixes.xmi_id for attribute in attributes_of_tag(source.text, source.start(place)))


def without_namespace(context: Context) -> dict[Element, str]:
    """The members of namespaces that have no `xmi:id`, with the names by which am2inc finds them."""
    members = (member for member in context.all(INamespaceMember) if member.namespace is not None and not has_id(member))
    return {member: f"{encode(name_of(member))}{TYPE_MARK}{type(member).__name__}" for member in members}
