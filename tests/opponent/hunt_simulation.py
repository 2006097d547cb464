"""Looks for random systems that are simulated wrongly: `python -m opponent.hunt_simulation FROM..TO` with `tests` on the path."""

from __future__ import annotations

import sys

from opponent.describe import described
from opponent.generator import random_system
from opponent.invariants import violations
from opponent.shrink import shrink
from opponent.simulation import contradictions


def main() -> None:
    """Print the smallest systems that fail."""
    first, end = map(int, sys.argv[1].split(".."))
    for seed in range(first, end):
        for check in (contradictions, violations):
            if check(random_system(seed)):
                system = shrink(random_system(seed), lambda candidate, check=check: bool(check(candidate)))  # type: ignore[misc]
                print(f"seed {seed}: {check(system)}\n{described(system)}", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
