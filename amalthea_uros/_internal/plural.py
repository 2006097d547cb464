"""Numbers of things, in the singular or plural, and lists of them."""

from __future__ import annotations

from collections.abc import Sequence


def counted(number: int, noun: str) -> str:
    """A number with its noun; the plural is regular, and that of a group of words is that of the last one.

    >>> counted(1, "finding"), counted(12_345, "object"), counted(2, "event chain")
    ('1 finding', '12,345 objects', '2 event chains')
    >>> counted(2, "class"), counted(0, "entity")
    ('2 classes', '0 entities')
    """
    return f"{number:,} {noun if number == 1 else _plural(noun)}"


def enumerated(texts: Sequence[str]) -> str:
    """Texts as a list in a sentence.

    >>> enumerated("a"), enumerated("ab"), enumerated("abc")
    ('a', 'a and b', 'a, b and c')
    """
    return " and ".join(filter(None, [", ".join(texts[:-1]), *texts[-1:]]))


def _plural(noun: str) -> str:
    if noun.endswith("y"):
        return f"{noun[:-1]}ies"
    return f"{noun}es" if noun.endswith("s") else f"{noun}s"
