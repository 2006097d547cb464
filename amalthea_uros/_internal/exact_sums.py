"""Exact sums of whole numbers and of their squares, which exceed 64 bits: times are picoseconds."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]

_HALF = 32
#: The sum of so many products of such digits fits into the 53 bits of a floating-point number.
_COLUMNS, _DIGIT_BITS = 2048, 21
_DIGIT = (1 << _DIGIT_BITS) - 1


def sums(values: Numbers) -> list[int]:
    """The sum of each row."""
    largest = max(abs(int(values.min())), abs(int(values.max())))
    if largest * values.shape[1] < 2**63:
        return [int(total) for total in values.sum(axis=1)]
    # Of both halves of the values.
    upper, lower = (values >> _HALF).sum(axis=1), (values & (1 << _HALF) - 1).sum(axis=1)
    return [(int(high) << _HALF) + int(low) for high, low in zip(upper, lower, strict=True)]


def sums_of_squares(values: Numbers) -> list[int]:
    """The sum of the squares of each row; many rows are those of times that do not vary."""
    found, rows = [0] * values.shape[0], np.flatnonzero(values.any(axis=1))
    for first in range(0, values.shape[1] if rows.size else 0, _COLUMNS):
        for shift, parts in _products(np.abs(values[rows, first : first + _COLUMNS])):
            for row, more in zip(rows.tolist(), parts.tolist(), strict=True):
                found[row] += int(more) << shift
    return found


def _products(values: Numbers) -> Iterator[tuple[int, NDArray[np.float64]]]:
    """The sums of squares of each row, as numbers that are to be shifted and added.

    The values are divided into digits so small that floating point, which is quicker, gives exact sums of their products.
    """
    digits = [(values & _DIGIT).astype(np.float64)]
    rest = values >> _DIGIT_BITS
    while rest.any():
        digits.append((rest & _DIGIT).astype(np.float64))
        rest = rest >> _DIGIT_BITS
    for (low, one), (high, other) in combinations_with_replacement(enumerate(digits), 2):
        twice = int(low != high)
        yield (low + high) * _DIGIT_BITS + twice, np.einsum("ij,ij->i", one, other)
