"""Counters: which occurrences take effect, and in which jobs that is.

Occurrence n takes effect if n >= max(offset, 1) and (n - offset) mod prescaler = 0. A counter belongs to its element of the model and
counts each time that the element is reached.
"""

from __future__ import annotations

from amalthea_uros.perf.stimuli import Counter

#: The counter of what is executed every time.
ALWAYS = Counter(prescaler=1, offset=1)


def first_effect(counter: Counter) -> int:
    """Number of the first occurrence that takes effect, counted from 1."""
    return counter.offset if counter.offset >= 1 else (counter.offset - 1) % counter.prescaler + 1


def is_always(counter: Counter) -> bool:
    """Whether every occurrence takes effect."""
    return counter.prescaler == 1 and first_effect(counter) == 1


def composed(outer: Counter, inner: Counter) -> Counter:
    """The counter of what happens at occurrences that `inner` lets take effect, of those that `outer` lets take effect."""
    if is_always(inner):
        return outer
    if is_always(outer):
        return inner
    return Counter(
        prescaler=outer.prescaler * inner.prescaler,
        offset=first_effect(outer) + (first_effect(inner) - 1) * outer.prescaler,
    )
