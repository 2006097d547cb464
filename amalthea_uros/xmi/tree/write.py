"""Nodes -> text, for versions that have no typed classes."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.metamodel.versions import NAMESPACE_PREFIX
from amalthea_uros.xmi.emf.escape import escape
from amalthea_uros.xmi.emf.header import XMI_NAMESPACE, XSI_NAMESPACE
from amalthea_uros.xmi.emf.versions import ITEA
from amalthea_uros.xmi.tree.classes import reference_text
from amalthea_uros.xmi.tree.model_set import Tree
from amalthea_uros.xmi.tree.node import Node

_ITEA_NAMESPACE = "http://www.amalthea.itea2.org/model/"
_ITEA_PACKAGES = (
    *("central", "common", "components", "config", "constraints", "events", "hw", "mapping", "os", "propertyconstraints"),
    *("stimuli", "sw"),
)

#: The package of the root of a file that holds one sub-model only.
_ROOT_PACKAGES = {
    "AMALTHEA": "central",
    "CommonElements": "common",
    "ComponentsModel": "components",
    "ConfigModel": "config",
    "ConstraintsModel": "constraints",
    "EventModel": "events",
    "HWModel": "hw",
    "MappingModel": "mapping",
    "OSModel": "os",
    "PropertyConstraintsModel": "propertyconstraints",
    "StimuliModel": "stimuli",
    "SWModel": "sw",
}


def tree_text(tree: Tree) -> str:
    """The text of a file: references by name, everything in the order of the nodes."""
    out = ['<?xml version="1.0" encoding="UTF-8"?>', *tree.prolog]
    prefix = "am"
    spaces = {"am": NAMESPACE_PREFIX + tree.version}
    if tree.version in ITEA:
        prefix = _ROOT_PACKAGES.get(tree.root.tag, "central")
        number = tree.version.rpartition(" ")[2]
        spaces = {package: f"{_ITEA_NAMESPACE}{number}/{package}" for package in _ITEA_PACKAGES}
    declared = {"xmi:version": "2.0", "xmlns:xmi": XMI_NAMESPACE, "xmlns:xsi": XSI_NAMESPACE}
    declared |= {f"xmlns:{name}": uri for name, uri in spaces.items()}
    _write(tree.root, f"{prefix}:{tree.root.tag}", declared, "", tree.root, out)
    return "\n".join([*out, *tree.epilog, ""])


def _write(node: Node, tag: str, attributes: dict[str, str], indent: str, root: Node, out: list[str]) -> None:
    out += [indent + comment for comment in node.comments or ()]
    if node.type:
        attributes["xsi:type"] = node.type if ":" in node.type else f"am:{node.type}"
    attributes |= node.attributes
    hrefs: list[tuple[str, Node]] = []
    for name, targets in node.references.items():
        if all(target.root is root for target in targets):
            attributes[name] = " ".join(map(reference_text, targets))
        else:
            hrefs += [(name, target) for target in targets]
    start = f"{indent}<{tag}" + "".join(_attributes(attributes.items()))
    if not node.children and not hrefs:
        out.append(start + "/>")
        return
    out.append(start + ">")
    for name, target in hrefs:
        out.append(f'{indent}  <{name} href="amlt:/#{escape(reference_text(target))}"/>')
    for child in node.children:
        _write(child, child.tag, {}, indent + "  ", root, out)
    out.append(f"{indent}</{tag}>")


def _attributes(items: Iterable[tuple[str, str]]) -> Iterable[str]:
    return (f' {name}="{escape(text)}"' for name, text in items)
