"""Looks for false claims in many random systems: `python -m opponent.hunt --seeds 0..100000` with `tests` on the path.

With `--simulation` it looks for systems that are simulated wrongly.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial

from opponent.claims import FalseClaim, Tally, false_claims
from opponent.generator import random_system
from opponent.invariants import violations
from opponent.shrink import shrink
from opponent.simulation import contradictions
from opponent.systems import PlainSystem, constructs_of, described

Found = tuple[int, list[FalseClaim], Tally]


def hunt(seed: int, plays: int, without: frozenset[str]) -> Found:
    """The false claims about the system of a seed, unless it has a construct that is left out."""
    system, tally = random_system(seed), Tally()
    if without & constructs_of(system):
        return seed, [], tally
    return seed, false_claims(system, plays, tally), tally


def kind(claim: FalseClaim) -> tuple[str, ...]:
    """What failures of the same kind have in common."""
    return claim.quantity, claim.claim, claim.method


def report(seed: int, claim: FalseClaim, plays: int) -> str:
    """A failure with its smallest system, as text."""

    def same(system: PlainSystem) -> FalseClaim | None:
        return next((found for found in false_claims(system, plays) if kind(found) == kind(claim)), None)

    system = shrink(random_system(seed), lambda candidate: same(candidate) is not None)
    return f"seed {seed}: {claim}\nsmallest: {same(system)}\n{described(system)}\n"


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="opponent.hunt", description=__doc__)
    parser.add_argument("--seeds", default="0..10000", metavar="FROM..TO", help="the last one is not included")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--simulation", action="store_true", help="look at simulations, in one process")
    parser.add_argument("--plays", type=int, default=4, help="under each reading")
    parser.add_argument("--without", nargs="*", default=(), metavar="CONSTRUCT", help="skip systems with these")
    parser.add_argument(
        "--shrink", type=int, default=3, metavar="N", help="show the smallest systems of N failures of each kind"
    )
    return parser.parse_args()


def _results(arguments: argparse.Namespace) -> Iterator[Found]:
    first, end = map(int, arguments.seeds.split(".."))
    seeds, one = range(first, end), partial(hunt, plays=arguments.plays, without=frozenset(arguments.without))
    if arguments.jobs == 1:
        yield from map(one, seeds)
        return
    with ProcessPoolExecutor(arguments.jobs) as pool:
        yield from pool.map(one, seeds, chunksize=20)


def _hunt_simulations(seeds: str) -> None:
    """Print the smallest systems that are simulated wrongly."""
    first, end = map(int, seeds.split(".."))
    for seed in range(first, end):
        for check in (contradictions, violations):
            if check(random_system(seed)):
                system = shrink(random_system(seed), lambda candidate, check=check: bool(check(candidate)))  # type: ignore[misc]
                print(f"seed {seed}: {check(system)}\n{described(system)}", flush=True)  # noqa: T201


def main() -> None:
    """Print the failing seeds, each with its smallest system, then the share of unknowns."""
    arguments = _arguments()
    if arguments.simulation:
        _hunt_simulations(arguments.seeds)
        return
    total, kinds = Tally(), Counter[tuple[str, ...]]()
    for seed, claims, tally in _results(arguments):
        total.add_all(tally)
        if not claims:
            continue
        kinds[kind(claims[0])] += 1
        is_shown = kinds[kind(claims[0])] <= arguments.shrink
        print(report(seed, claims[0], arguments.plays) if is_shown else f"seed {seed}: {claims[0]}", flush=True)  # noqa: T201
    print(f"{kinds.total()} failing systems\n{total.text()}")  # noqa: T201


if __name__ == "__main__":
    main()
