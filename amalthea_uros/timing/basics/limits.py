"""Limits of times: sums of a few of them must fit into 64 bits."""

from __future__ import annotations

from amalthea_uros.units import Time

#: Longer times are treated as unbounded: 13 days in picoseconds.
LIMIT: Time = 2**60
#: Sums of some such times still fit into 64 bits.
MAX_INPUT: Time = LIMIT // 64
