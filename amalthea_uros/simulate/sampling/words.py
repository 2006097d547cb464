"""Random words, and the arithmetic of binary fractions that values are made of."""

from __future__ import annotations

from hashlib import blake2b

import numpy as np

from amalthea_uros._internal.arrays import Words


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


# Arithmetic of binary fractions: a word of 64 bits stands for its value divided by 2**64, at least 0 and less than 1.

_HALF = np.uint64(32)
#: Selects the lower half of a word.
LOWER_HALF = np.uint64(2**32 - 1)


def scaled(fractions: Words, factor: int | Words, dither: Words | None = None) -> Words:
    """The products of fractions and a number, rounded down.

    Parameters
    ----------
    factor : less than 2**64
    dither : 32 bits each; uniform random ones make the mean of the results that of the exact products. Not for factors from 2**32 on,
        where rounding does not matter
    """
    high, low = fractions >> _HALF, fractions & LOWER_HALF
    if isinstance(factor, int) and factor < 2**32:
        product: Words = high * np.uint64(factor) + (low * np.uint64(factor) >> _HALF)
        if dither is not None:
            product += dither
        product >>= _HALF
        return product
    whole: Words = np.asarray(factor, np.uint64)
    top, bottom = whole >> _HALF, whole & LOWER_HALF
    # None of the sums overflows: a product of two halves leaves room for two more halves.
    middle: Words = high * bottom + (low * bottom >> _HALF)
    lower: Words = low * top + (middle & LOWER_HALF)
    found: Words = high * top + (middle >> _HALF) + (lower >> _HALF)
    return found
