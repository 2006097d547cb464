"""The memory of the kernel."""

from __future__ import annotations

from typing import TypeAlias

#: A list if the kernel is interpreted; an array of int64 if it is machine code, of which no more is asked than of a list.
Memory: TypeAlias = list[int]
