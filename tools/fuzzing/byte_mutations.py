"""Mutations of any file by its bytes: numbers at limits, pieces of other files, nesting, long lists."""

from __future__ import annotations

import re
from random import Random

_NUMBER = re.compile(rb"\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_HOSTILE = (
    b"", b"-1", b"0", b"1e30", b"1e400", b"nan", b"inf", b"-inf", b"9" * 25, b"18446744073709551615", b"-9223372036854775808",
    b"4294967296", b"1e-400", b"0x7fffffffffffffff", b"0.5", b"9" * 5000, b"\xc2\xb2", b"null", b"[]", b"{}", b"true", b"\x00", b'"',
)  # fmt: skip
_BYTES = (b"\x00", b"\xff", b"\x7f", b"\x80", b"\n", b",", b":", b"(", b")", b"<", b"{", b"}")
#: Those that are numbers wherever numbers are, but larger or smaller than anybody expects.
_LIMITS = (b"0", b"1", b"100000", b"1000000000", b"4294967296", b"18446744073709551615", b"9" * 25)
#: Sizes and counts in binary files.
_WORDS = tuple(
    number.to_bytes(size, "little")
    for size in (2, 4, 8)
    for number in (0, 1, 2 ** (8 * size) - 1, 2 ** (8 * size - 1), 2 ** (8 * size - 1) - 1)
)
#: What opens something, and what closes it.
_BRACKETS = (
    (b"(", b")"),
    (b"[", b"]"),
    (b"{", b"}"),
    (b"<a>", b"</a>"),
    (b"- ", b""),
    (b'{"a":', b"}"),
    (b"struct {", b"} x;"),
)
_DEPTHS = (2, 50, 2_000, 100_000)
_COUNTS = (2, 20, 1_000)
_MAX_LIST = 400_000


def number(rng: Random, content: bytes, _other: bytes) -> bytes:
    """With another number in words."""
    found = list(_NUMBER.finditer(content))
    if not found:
        return content
    place = rng.choice(found)
    return content[: place.start()] + rng.choice(rng.choice((_LIMITS, _HOSTILE))) + content[place.end() :]


def some_bytes(rng: Random, content: bytes, _other: bytes) -> bytes:
    """With other bytes, or further ones."""
    at, new = rng.randrange(len(content) + 1), rng.choice((*_BYTES, bytes([rng.randrange(256)])))
    return content[:at] + new + content[at + rng.choice((0, 1, len(new))) :]


def word(rng: Random, content: bytes, _other: bytes) -> bytes:
    """With another binary number."""
    new = rng.choice(_WORDS)
    at = rng.randrange(len(content) + 1) // 2 * 2
    return content[:at] + new + content[at + len(new) :]


def line(rng: Random, content: bytes, _other: bytes) -> bytes:
    """With a line at another place, or once more."""
    lines = content.split(b"\n")
    moved = lines.pop(rng.randrange(len(lines))) if rng.random() < 0.5 else rng.choice(lines)
    lines.insert(rng.randrange(len(lines) + 1), moved)
    return b"\n".join(lines)


def cut(rng: Random, content: bytes, _other: bytes) -> bytes:
    """Without some bytes."""
    start = rng.randrange(len(content) + 1)
    return content[:start] + content[start + rng.choice((1, 4, 40, 4000)) :]


def splice(rng: Random, content: bytes, other: bytes) -> bytes:
    """With some lines of another file for the same reader."""
    lines, more = content.split(b"\n"), other.split(b"\n")
    at, start = rng.randrange(len(lines) + 1), rng.randrange(len(more))
    lines[at : at + rng.choice((0, 0, 1, 5))] = more[start : start + rng.choice((1, 2, 10, 100))]
    return b"\n".join(lines)


def nest(rng: Random, content: bytes, _other: bytes) -> bytes:
    """With a piece in many brackets, which may stay open."""
    (opening, closing), depth = rng.choice(_BRACKETS), rng.choice(_DEPTHS)
    start = rng.randrange(len(content) + 1)
    end = start + rng.choice((0, 1, 10))
    return content[:start] + opening * depth + content[start:end] + rng.choice((closing * depth, b"")) + content[end:]


def many(rng: Random, content: bytes, _other: bytes) -> bytes:
    """With a line, or a word of a list, very often."""
    separator = rng.choice((b"\n", b"\n", b" ", b","))
    parts = content.split(separator)
    at = rng.randrange(len(parts))
    parts[at : at + 1] = [parts[at]] * min(rng.choice(_COUNTS), 1 + _MAX_LIST // (len(parts[at]) + 1))
    return separator.join(parts)


MUTATIONS = (*(number,) * 6, some_bytes, some_bytes, word, line, cut, splice, splice, nest, many)
