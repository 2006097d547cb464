"""What the benchmarks need to know of a model file before it is loaded."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lxml import etree

if TYPE_CHECKING:
    from pathlib import Path


def root_tag(path: Path) -> etree.QName:
    """The namespace and name of the root element."""
    _, root = next(etree.iterparse(path, events=("start",)))
    return etree.QName(root)


def file_version(path: Path) -> str:
    """The AMALTHEA version, which stands at the end of the namespace."""
    return str(root_tag(path).namespace).rpartition("/")[2]


def write_empty(like: Path, path: Path) -> None:
    """Writes a model with nothing in it, of the same version as another file."""
    tag = root_tag(like)
    path.write_text(f'<m:{tag.localname} xmlns:m="{tag.namespace}"/>\n', encoding="utf-8")
