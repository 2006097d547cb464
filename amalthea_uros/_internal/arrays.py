"""Names for types of arrays, for annotations only: importing them does not import numpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: Whole numbers, such as times or numbers of jobs.
Numbers: TypeAlias = "NDArray[np.int64]"
#: Words of 64 bits.
Words: TypeAlias = "NDArray[np.uint64]"
Floats: TypeAlias = "NDArray[np.float64]"
Flags: TypeAlias = "NDArray[np.bool_]"
