"""How much is tried: a part by default, everything with `HYPOTHESIS_PROFILE=thorough`.

A usual run has fewer examples of each property, and a sample of the published models and cases: the same one each time.
"""

import os
from collections.abc import Hashable, Iterable, Iterator, Sequence
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import Any, TypeVar
from zlib import crc32

from hypothesis import settings

T = TypeVar("T")

#: The examples of a property by default, and where time does not matter.
USUAL, THOROUGH = 6, 1000

PROFILE = os.environ.get("HYPOTHESIS_PROFILE") or ("ci" if os.environ.get("CI") else "default")
IS_THOROUGH = PROFILE == "thorough"


def examples(count: int) -> settings:
    """Another number of examples than usual for a property, of 16; a usual run tries a sixth of them, a thorough one many more."""
    return settings(max_examples=count * THOROUGH // 16 if IS_THOROUGH else max(1, count // 6))


def every(step: int, cases: Sequence[T]) -> Sequence[T]:
    """Each `step`-th of many cases that are alike; all of them in a thorough run."""
    return cases if IS_THOROUGH else cases[::step]


#: Of so many published cases of a test, a usual run takes a part of about this number.
SAMPLE = 20


def sample(items: Iterable[Any]) -> Iterator[Any]:
    """The items of pytest without those that a usual run leaves out; tests take different cases."""
    for (name, is_published), group in groupby(items, lambda item: (_name(item), _is_published(item))):
        found = list(group)
        step = max(1, len(found) // SAMPLE) if is_published else 1
        yield from found[crc32(str(name).encode()) % step :: step]


def _name(item: Any) -> Hashable:
    return _relative(item.path, item.config.rootpath), getattr(item, "originalname", item.name)


@cache
def _relative(path: Path, root: Path) -> str:
    """The path of tests as a text, so that the sample is the same wherever the project is."""
    return str(path.relative_to(root))


def _is_published(item: Any) -> bool:
    """Whether a test looks at one of many published models or cases."""
    values = item.callspec.params.values() if hasattr(item, "callspec") else ()
    return any(
        (isinstance(value, dict) and "id" in value)
        or (isinstance(value, str | Path) and str(value).endswith((".amxmi", ".iprx")))
        for value in values
    )
