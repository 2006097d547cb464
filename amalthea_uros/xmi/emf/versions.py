"""Every version that was ever published, in order, and the namespaces by which files declare them."""

from __future__ import annotations

import re
from xml.parsers import expat

from amalthea_uros.metamodel.versions import NAMESPACE_PREFIX, OLDEST_SUPPORTED

#: Versions of the ITEA project, which preceded APP4MC. The number is that of the namespace, not of the release: namespace 1.1.0 is
#: release 1.0.3, namespace 1.2.0 is release 1.1.0, namespace 1.3.0 is release 1.1.1.
ITEA = ("ITEA 1.1.0", "ITEA 1.2.0", "ITEA 1.3.0")

VERSIONS = (
    *ITEA,
    *("0.7.0", "0.7.1", "0.7.2"),
    *("0.8.0", "0.8.1", "0.8.2", "0.8.3"),
    *("0.9.0", "0.9.1", "0.9.2", "0.9.3", "0.9.4", "0.9.5", "0.9.6", "0.9.7", "0.9.8", "0.9.9"),
    *("1.0.0", "1.1.0", "1.2.0"),
    *("2.0.0", "2.1.0", "2.2.0"),
    *("3.0.0", "3.1.0", "3.2.0", "3.3.0"),
)

_POSITIONS = {version: position for position, version in enumerate(VERSIONS)}

_ITEA_NAMESPACE = re.compile(r"http://(?:www\.)?amalthea\.itea2\.org/model/([0-9.]+)/([a-z]+)").fullmatch


def position(version: str) -> int:
    """The place of a version in the order of publication.

    Raises
    ------
    KeyError : there is no such version.
    """
    return _POSITIONS[version]


def is_known(version: str) -> bool:
    """Whether the version was ever published."""
    return version in _POSITIONS


def namespace_version(namespace: str) -> str:
    """The version that a namespace belongs to, also an unknown one; "" if it is not a namespace of AMALTHEA."""
    itea = _ITEA_NAMESPACE(namespace)
    if itea:
        return f"ITEA {itea[1]}"
    return namespace.removeprefix(NAMESPACE_PREFIX) if namespace.startswith(NAMESPACE_PREFIX) else ""


def itea_package(namespace: str) -> str:
    """The sub-model that a namespace of an ITEA version belongs to, such as "sw"; "" for any other namespace."""
    itea = _ITEA_NAMESPACE(namespace)
    return itea[2] if itea else ""


def is_older(version: str) -> bool:
    """Whether models of a published version cannot be held by the classes without migration."""
    return version in _POSITIONS and _POSITIONS[version] < _POSITIONS[OLDEST_SUPPORTED]


def migrated_name(name: str, target: str) -> str:
    """The name of a file in another version: until ITEA 1.2.0, sub-models had suffixes of their own, such as `.amxmi-sw`."""
    is_sub_model = ".amxmi-" in name and not name.endswith(".amxmi")
    return name + ".amxmi" if is_sub_model and position(target) >= position("ITEA 1.3.0") else name


#: Bytes that are parsed first in search of the root.
_PIECE = 10_000


def version_of(utf8: bytes) -> str:
    """The AMALTHEA version that a file declares, "" if its root is not that of a model, or if it cannot be read."""
    parser = expat.ParserCreate("utf-8")
    #: The version of the root element; "" at a document type declaration, which is refused elsewhere.
    found: list[str] = []

    def at_root(name: str, attributes: dict[str, str]) -> None:
        prefix, mark, _ = name.rpartition(":")
        found.append(namespace_version(attributes.get(f"xmlns{mark}{prefix}", "")))
        parser.StartElementHandler = None

    parser.StartElementHandler = at_root
    parser.StartDoctypeDeclHandler = lambda *_declaration: found.append("")
    try:
        # The root is mostly near the start, but comments in front of it may have any length. Pieces double, because expat begins again
        # with a token that is not complete.
        end = 0
        while end < len(utf8) and not found:
            start, end = end, 2 * end or _PIECE
            # At the end it parses what it has put off, as newer ones do with incomplete tokens.
            parser.Parse(utf8[start:end], end >= len(utf8))
    except expat.ExpatError:
        pass
    return found[0] if found else ""
