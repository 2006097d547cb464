"""Values that authors, converters and other tools get wrong."""

from __future__ import annotations

NUMBERS = ("0", "1", "-1", "1.5", "010", "0x10", "1e400", "-0", "NaN", ".inf", "9223372036854775808", "9" * 60)
WORDS = ("", " ", "true", "on", "null", "~", "2024-01-01", "1:30", "1,5 ms", "a/b", "a b", "x" * 3000)
CHARACTERS = ("名前 😀", "\u202e", "a\n::error::b", "##[b]", "\x9b1m", "\u00a0", "e\u0301", "%ZZ", "#", "?type=", "'", "&amp;")
QUANTITIES = (
    "0 ms",
    "-1 ms",
    "1 ps",
    "1e400 ms",
    "99999999 h",
    "10ms",
    "10 Ms",
    "1 μs",
    "0 Hz",
    "1 GHz",
    "0 B",
    "1 TB",
    "0 bit/s",
)
VALUES = (*NUMBERS, *WORDS, *CHARACTERS, *QUANTITIES)
