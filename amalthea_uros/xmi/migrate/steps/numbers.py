"""Numbers in attributes, of which any text may be damaged."""

from __future__ import annotations

import re

from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes

# More digits than any number of a model has, and fewer than Python converts.
_INTEGER = re.compile(r"[+-]?[0-9]{1,1000}").fullmatch


def whole_number(text: str) -> int | None:
    """The number that a text is, None if it is none."""
    return int(text) if _INTEGER(text) else None


def make_positive(node: Node, attribute: str, notes: Notes) -> None:
    """Replace a written 0 by the smallest number that is allowed now, which is also the new default; negative numbers never meant
    anything.
    """
    if attribute not in node.attributes:
        notes.to_check(node, f"{attribute} is not stated: it was 0 by default, and is 1 now", "", attribute)
        return
    number = whole_number(node.get(attribute))
    if number == 0:
        node.attributes[attribute] = "1"
        notes.converted(node, f"{attribute} 0 is not allowed any more, and is 1 now", "", attribute)
    elif number is not None and number < 0:
        notes.to_check(node, f"{attribute} must be positive", str(number), attribute)
