"""The root element: is it an AMALTHEA model, of which version, and which prefixes does it use."""

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

XMI_NAMESPACE = "http://www.omg.org/XMI"
XSI_NAMESPACE = "http://www.w3.org/2001/XMLSchema-instance"

_VERSION = re.compile(r"[0-9]{1,4}(\.[0-9]{1,4}){1,3}").fullmatch


class Header(NamedTuple):
    """What the root element says.

    Attributes
    ----------
    version : AMALTHEA version as declared
    facts_version : the version with whose facts the model is read
    xmi_id, xsi_type : names of the special attributes in this document
    type_prefix : what stands in front of class names in `xsi:type`
    own_attributes : attributes of the root that belong to XML and XMI, not to the model
    """

    version: str
    facts_version: str
    xmi_id: str
    xsi_type: str
    type_prefix: str
    own_attributes: frozenset[str]

    @property
    def version_note(self) -> str:
        """What a finding says about an unknown version, "" for a known one."""
        if self.version in known_versions():
            return ""
        newer = version_key(self.version) > version_key(newest_version())
        known = "newer than the known versions" if newer else "not among the known versions"
        return f"AMALTHEA {self.version} is {known}, the model is read as {self.facts_version}"


class NotAModelError(Exception):
    """The root element is not that of a model that can be read.

    Attributes
    ----------
    rule, message, help : what a finding about it says
    """

    def __init__(self, rule: str, message: str, help_text: str = "") -> None:
        super().__init__(rule, message, help_text)
        self.rule, self.message, self.help = rule, message, help_text


def read_header(name: str, attributes: dict[str, str]) -> Header:
    """What the root element says.

    Raises
    ------
    NotAModelError : it is not `am:Amalthea`, or its version is too old.
    """
    prefix, _, local = name.rpartition(":")
    namespace = attributes.get(f"xmlns:{prefix}" if prefix else "xmlns", "")
    if "itea2.org/model" in namespace:
        raise NotAModelError("XMI006", "the model is of an ITEA version of AMALTHEA, from before APP4MC 0.7", _MIGRATE)
    if local != "Amalthea" or not prefix or not namespace.startswith(NAMESPACE_PREFIX):
        within = f" in namespace {namespace}" if namespace else ""
        raise NotAModelError(
            "XMI005",
            f"the root element is <{name}>{within}, not <am:Amalthea>: this is not an AMALTHEA model",
            f'A model starts with <am:Amalthea xmlns:am="{NAMESPACE_PREFIX}{newest_version()}" ...>.',
        )
    version = namespace.removeprefix(NAMESPACE_PREFIX)
    if not _VERSION(version):
        raise NotAModelError("XMI005", f"namespace {namespace} names no AMALTHEA version")
    if version_key(version) < version_key(OLDEST_SUPPORTED):
        raise NotAModelError("XMI006", f"the model is of AMALTHEA {version}, older than {OLDEST_SUPPORTED}", _MIGRATE)
    prefixes = {uri: key.partition(":")[2] for key, uri in attributes.items() if key.startswith("xmlns:")}
    for usual, uri in (("xmi", XMI_NAMESPACE), ("xsi", XSI_NAMESPACE)):
        given = attributes.get(f"xmlns:{usual}", uri)
        if given != uri:
            raise NotAModelError("XMI005", f"the prefix {usual!r} stands for {given!r}", f'It has to be xmlns:{usual}="{uri}".')
    xmi, xsi = prefixes.get(XMI_NAMESPACE, "xmi"), prefixes.get(XSI_NAMESPACE, "xsi")
    return Header(
        version=version,
        facts_version=nearest_version(version),
        xmi_id=f"{xmi}:id",
        xsi_type=f"{xsi}:type",
        type_prefix=f"{prefix}:",
        own_attributes=frozenset(k for k in attributes if k.startswith(("xmlns", f"{xmi}:version", f"{xsi}:"))),
    )


_MIGRATE = f"Such models have another structure; migrate it with Eclipse APP4MC to {OLDEST_SUPPORTED} or newer."
