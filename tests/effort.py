"""How much is tried: a part by default, everything with `HYPOTHESIS_PROFILE=thorough`."""

import os
from collections.abc import Sequence
from typing import TypeVar

from hypothesis import settings

T = TypeVar("T")

#: The examples of a property by default, and where time does not matter.
USUAL, THOROUGH = 16, 1000

PROFILE = os.environ.get("HYPOTHESIS_PROFILE") or ("ci" if os.environ.get("CI") else "default")
IS_THOROUGH = PROFILE == "thorough"


def examples(count: int) -> settings:
    """Another number of examples than usual for a property; a thorough run multiplies it, too."""
    return settings(max_examples=count * THOROUGH // USUAL if IS_THOROUGH else count)


def every(step: int, cases: Sequence[T]) -> Sequence[T]:
    """Each `step`-th of many cases that are alike; all of them in a thorough run."""
    return cases if IS_THOROUGH else cases[::step]
