"""Names in BTF files, which know no quotes: what would end a field or a line is written as a percent sign and two digits.

That is a comma, a control character, a blank at either end, which readers drop, and a percent sign before two digits.
"""

from __future__ import annotations

import re

#: What may be around fields and at the ends of lines; other white space belongs to names.
BLANKS = " \t\r\n"

_UNWRITABLE = re.compile(r"[,\x00-\x1f\x7f]|^ | $|%(?=[0-9A-F]{2})")
_ESCAPED = re.compile(r"%([0-9A-F]{2})")


def escape(name: str) -> str:
    """A name as it is written."""
    return _UNWRITABLE.sub(lambda found: f"%{ord(found[0]):02X}", name)


def unescape(text: str) -> str:
    """A name that `escape` has written; names of other tools hardly ever look like that."""
    return _ESCAPED.sub(lambda found: chr(int(found[1], 16)), text) if "%" in text else text
