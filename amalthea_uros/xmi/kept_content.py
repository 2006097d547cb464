"""Unknown content of a file when it is written again: where it goes, and which namespaces it needs."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from amalthea_uros.metamodel.element import Element
from amalthea_uros.xmi.emf_serializer import Child, Part

_TAG = re.compile(r"<([^\s/>!?]+)")
#: Prefixes of elements and attributes, and of names in values such as that of `xsi:type`.
_PREFIX = re.compile(r"(?<![\w.:-])([\w.-]+):(?=\w)")


class KeptContent(NamedTuple):
    """The unknown content of one element among its children.

    Attributes
    ----------
    before : what comes before a part (None: at the end)
    after : what comes after the child of a feature
    """

    before: dict[Element | None, list[str]]
    after: dict[str, list[str]]

    @classmethod
    def of(cls, content: Sequence[tuple[Element | None, str]], children: Sequence[Child]) -> KeptContent:
        """The places of the content. Where only one value is allowed, readers use the first; further ones stay after it."""
        before: dict[Element | None, list[str]] = {}
        after: dict[str, list[str]] = {}
        if content:
            parts = {child.element for child in children if isinstance(child, Part)}
            single = {child.feature.xml_name for child in children if not child.feature.many or child.feature.only_one}
            for anchor, raw in content:
                tag = tag_of(raw)
                if tag in single:
                    after.setdefault(tag, []).append(raw)
                else:
                    before.setdefault(anchor if anchor in parts else None, []).append(raw)
        return cls(before, after)


def tag_of(raw: str) -> str:
    """The name of an unknown element, "" for anything else."""
    found = _TAG.match(raw)
    return found[1] if found else ""


def used_prefixes(kept: Iterable[str]) -> set[str]:
    """The prefixes that unknown content may need."""
    return {prefix for raw in kept if ":" in raw and not raw.startswith(("<!", "<?")) for prefix in _PREFIX.findall(raw)}
