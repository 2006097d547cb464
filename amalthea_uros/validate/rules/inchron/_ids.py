"""How am2inc resolves references: by `xmi:id`, or else by computed names without namespaces."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import INamespaceMember
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.naming import TYPE_MARK, encode, name_of, segments
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rules.inchron._tags import tag_of


def has_id(element: Element) -> bool:
    """Whether an object has an `xmi:id` in its file. An object that was not read from a file will be written with one."""
    tag = tag_of(element)
    return tag is None or tag[0].prefixes.xmi_id in tag[1]


def without_namespace(context: Context) -> dict[Element, str]:
    """The members of namespaces that have no `xmi:id`, with the names by which am2inc finds them."""
    members = (member for member in context.all(INamespaceMember) if member.namespace is not None and not has_id(member))
    return {member: f"{encode(name_of(member))}{TYPE_MARK}{type(member).__name__}" for member in members}


def has_encoded_name(element: Element) -> bool:
    """Whether references encode characters of a name; am2inc computes names without encoding."""
    return any(segment and segment != encode(segment) for segment in segments(element))
