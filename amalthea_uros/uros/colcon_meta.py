"""The file `colcon.meta`, which sets build options of the middleware: https://colcon.readthedocs.io/en/released/user/configuration.html."""

from __future__ import annotations

import json
from collections.abc import Iterable

from amalthea_uros.uros.pools import Pool

#: The package whose pools these are.
_PACKAGE = "rmw_microxrcedds"


def colcon_meta(pools: Iterable[Pool]) -> str:
    """The sizes of pools: as they are described, but never smaller than needed; pools that are not needed keep their defaults."""
    sizes = [f"-D{pool.option}={_size(pool)}" for pool in pools if pool.needed]
    return json.dumps({"names": {_PACKAGE: {"cmake-args": sizes}}}, indent=2) + "\n"


def _size(pool: Pool) -> int:
    return max(pool.needed, pool.available) if pool.configured else pool.needed
