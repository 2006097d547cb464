"""Delta debugging: the smallest part of a case that still fails in the same way.

A. Zeller, R. Hildebrandt: Simplifying and isolating failure-inducing input, IEEE Transactions on Software Engineering 28(2), 2002.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from fuzzing.cases import Case


def shrunk(case: Case, still_fails: Callable[[Case], bool]) -> Case:
    """The case without lines, then without smaller parts, that the failure does not need."""
    try:
        text = case.content.decode()
    except UnicodeDecodeError:
        return case

    def fails(parts: list[str]) -> bool:
        return still_fails(replace(case, content="".join(parts).encode(errors="surrogatepass")))

    lines = minimal(text.splitlines(keepends=True), fails)
    parts = [part for line in lines for part in re.split(r"(?=\s[\w:.-]+=\")|(?<=[,{}\[\]])", line)]
    return replace(case, content="".join(minimal(parts, fails)).encode(errors="surrogatepass"))


def minimal(parts: list[str], fails: Callable[[list[str]], bool]) -> list[str]:
    """A part of a list that fails, and of which no element can be left out (algorithm ddmin, complements only)."""
    size = len(parts) // 2
    while size >= 1:
        start = 0
        while start < len(parts):
            rest = parts[:start] + parts[start + size :]
            if rest and fails(rest):
                parts = rest
            else:
                start += size
        size //= 2
    return parts
