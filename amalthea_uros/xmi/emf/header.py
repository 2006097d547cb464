"""The root element: whether it is an AMALTHEA model, its version, and the prefixes that it uses."""

from __future__ import annotations

import re
from typing import NamedTuple

from amalthea_uros.metamodel.versions import (
    NAMESPACE_PREFIX,
    OLDEST_SUPPORTED,
    known_versions,
    nearest_version,
    newest_version,
    version_key,
)
from amalthea_uros.xmi.emf.versions import namespace_version

XMI_NAMESPACE = "http://www.omg.org/XMI"
XSI_NAMESPACE = "http://www.w3.org/2001/XMLSchema-instance"

_VERSION = re.compile(r"[0-9]{1,4}(\.[0-9]{1,4}){1,3}").fullmatch


class ModelHeader(NamedTuple):
    """The declarations of the root element.

    Attributes
    ----------
    version : AMALTHEA version as declared
    facts_version : the version as which the model is read
    xmi_id, xsi_type : names of the special attributes in this document
    type_prefix : prefix of class names in `xsi:type`
    own_attributes : attributes of the root that belong to XML and XMI, not to the model
    namespaces : the namespaces that the root declares, by prefix
    """

    version: str
    facts_version: str
    xmi_id: str
    xsi_type: str
    type_prefix: str
    own_attributes: frozenset[str]
    namespaces: dict[str, str]

    @property
    def version_note(self) -> str:
        """What a finding says about an unknown version, "" for a known one."""
        if self.version in known_versions():
            return ""
        newer = version_key(self.version) > version_key(newest_version())
        known = "newer than the known versions" if newer else "not a known version"
        return f"AMALTHEA {self.version} is {known}; the model is read as {self.facts_version}"


class NotAModel(NamedTuple):
    """Why the root element is not that of a model that can be read: the content of the finding."""

    rule: str
    message: str
    help: str = ""


def read_header(name: str, attributes: dict[str, str]) -> ModelHeader | NotAModel:
    """The declarations of a root element, unless it is not `am:Amalthea`, or its version was never published."""
    prefix, _, local = name.rpartition(":")
    namespace = attributes.get(f"xmlns:{prefix}" if prefix else "xmlns", "")
    if "itea2.org/model" in namespace:
        return NotAModel("XMI006", f"{namespace_version(namespace) or namespace} is no known version of AMALTHEA", _VERSIONS)
    if local != "Amalthea" or not prefix or not namespace.startswith(NAMESPACE_PREFIX):
        within = f" in namespace {namespace}" if namespace else ""
        return NotAModel(
            "XMI005",
            f"not an AMALTHEA model: the root element is <{name}>{within}, expected <am:Amalthea>",
            f'A model starts with <am:Amalthea xmlns:am="{NAMESPACE_PREFIX}{newest_version()}" ...>.',
        )
    version = namespace.removeprefix(NAMESPACE_PREFIX)
    if not _VERSION(version):
        return NotAModel("XMI005", f"namespace {namespace} does not end with an AMALTHEA version")
    if version_key(version) < version_key(OLDEST_SUPPORTED):
        return NotAModel("XMI006", f"AMALTHEA {version} was never published", _VERSIONS)
    namespaces = {key.partition(":")[2]: uri for key, uri in attributes.items() if key.startswith("xmlns:")}
    for usual, uri in (("xmi", XMI_NAMESPACE), ("xsi", XSI_NAMESPACE)):
        given = namespaces.get(usual, uri)
        if given != uri:
            return NotAModel("XMI005", f"the prefix {usual!r} is bound to {given!r}", f'Write xmlns:{usual}="{uri}".')
    xmi, xsi = _prefix(namespaces, XMI_NAMESPACE, "xmi"), _prefix(namespaces, XSI_NAMESPACE, "xsi")
    return ModelHeader(
        version=version,
        facts_version=nearest_version(version),
        xmi_id=f"{xmi}:id",
        xsi_type=f"{xsi}:type",
        type_prefix=f"{prefix}:",
        own_attributes=frozenset(k for k in attributes if k.startswith(("xmlns", f"{xmi}:version", f"{xsi}:"))),
        namespaces=namespaces,
    )


def _prefix(namespaces: dict[str, str], namespace: str, usual: str) -> str:
    """The prefix of a namespace: the usual one, if it is among several."""
    declared = [prefix for prefix, uri in namespaces.items() if uri == namespace]
    return usual if usual in declared or not declared else declared[0]


#: Files of published versions before 0.9.7 are not read directly; they are migrated.
_VERSIONS = "Correct the version in the namespace; known ones are 1.1.0, 1.2.0 and 1.3.0 of ITEA, and 0.7.0 to 3.3.0 of APP4MC."
