"""Elements of SVG as text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NewType
from xml.sax.saxutils import escape, quoteattr

from amalthea_uros.report.escape import visible

#: Text that is well-formed SVG.
Markup = NewType("Markup", str)


def text(content: str) -> Markup:
    """Characters, with those escaped that XML gives a meaning."""
    return Markup(escape(visible(content)))


def element(tag: str, *children: Markup, **attributes: str | float) -> Markup:
    """An element; an underscore at the end of an attribute's name is dropped, others become hyphens.

    >>> element("text", text("a < b"), class_="small", text_anchor="end", x=1.50)
    '<text class="small" text-anchor="end" x="1.5">a &lt; b</text>'
    """
    written = "".join(f" {name.rstrip('_').replace('_', '-')}={_attribute(value)}" for name, value in attributes.items())
    content = "".join(children)
    return Markup(f"<{tag}{written}>{content}</{tag}>" if content else f"<{tag}{written}/>")


def joined(parts: Iterable[Markup]) -> Markup:
    """One element after the other, each in a line of its own."""
    return Markup("\n".join(parts))


def tooltip(content: str) -> Markup:
    """What is shown where the pointer rests on the element around it."""
    return element("title", text(content))


def number(value: float) -> str:
    """A coordinate, to a hundredth of a pixel."""
    # Adding zero makes a zero of a negative zero.
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def _attribute(value: str | float) -> str:
    return quoteattr(visible(value)) if isinstance(value, str) else f'"{number(value)}"'
