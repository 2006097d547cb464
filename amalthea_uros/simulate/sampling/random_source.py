"""Random words: reproducible, and independent for each place of a model that draws."""

from __future__ import annotations

from hashlib import blake2b
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Words = NDArray[np.uint64]


class RandomSource:
    """Independent 64-bit words, each value equally probable.

    Philox is a cipher of a counter: its words are the same on every machine, and different keys give independent sequences
    (J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011).

    Parameters
    ----------
    seed : of the run
    place : what draws, e.g. "stimulus timer"; other places get other words, so that adding one changes no other
    """

    def __init__(self, seed: int, place: str) -> None:
        key = blake2b(f"{seed} {place}".encode(), digest_size=16).digest()
        self._generator = np.random.Philox(key=int.from_bytes(key, "little"))

    def words(self, count: int) -> Words:
        """The next words."""
        return self._generator.random_raw(count)
