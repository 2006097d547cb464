"""Looks for false answers about random applications with executors that spin in loops.

`python -m opponent.hunt_executors --seeds 0..10000 --jobs 2 --out FOLDER` with `tests` and `tools` on the path, e.g.
`PYTHONPATH=.:tests:tools` in the folder of the project. For each seed it compares

- calls: a random executor, and a random application on a wire, each simulated and played step by step by a player that shares no
  code with the simulation; every call has the same response time;
- bounds: a random description with every construct, analysed, and simulated with the least and the greatest of everything and with
  two seeds: no observed value is beyond a bound, nothing is lost that cannot be, and no limit is missed that is met;
- items: the same of a description in which the thread of a loop does more than spin;
- losses: the same of a description whose wire loses a stated number of messages;
- robots: the same of several controllers, which send each other messages, with a host;
- actions, robot-actions: the same of both, with actions instead of most services.

`--only calls` and `--only bounds` leave the other one out. It prints each kind of failure with its seed, and writes the smallest
description of each to the folder. At the end it prints a table: for each construct the number of observed maxima of applications with
it, the share of them that have a bound, and the median and the maximum of observed/bound.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import yaml
from opponent.executors.actions import description_with_actions, robot_with_actions
from opponent.executors.calls import different_calls
from opponent.executors.claims import false_claims, runs_of
from opponent.executors.descriptions import random_description
from opponent.executors.loop_items import description_with_items
from opponent.executors.lossy import description_with_losses
from opponent.executors.robots import random_robot
from opponent.executors.shrinking import kind_of, shrunk
from opponent.executors.tally import Tally

from amalthea_uros.units import SECOND

#: How the descriptions of each kind of hunt are drawn.
DESCRIPTIONS = {
    "bounds": random_description,
    "items": description_with_items,
    "losses": description_with_losses,
    "robots": random_robot,
    "actions": description_with_actions,
    "robot-actions": robot_with_actions,
}
#: The runs of those that need others.
RUNS = {"losses": runs_of(2 * SECOND, (1,))}

Found = tuple[int, list[str], Tally]
Hunt = Callable[[int, Tally], list[str]]


def hunt(only: str, heartbeats: bool, seed: int) -> Found:
    """The false answers about the applications of a seed."""
    tally, said = Tally(), []
    hunts: dict[str, Hunt] = {
        "calls": different_calls,
        **{
            kind: lambda seed, tally, kind=kind, draw=draw: false_claims(
                draw(seed), tally, heartbeats=heartbeats, runs=RUNS.get(kind, ())
            )
            for kind, draw in DESCRIPTIONS.items()
        },
    }
    for name, each in hunts.items():
        if only in (name, "all"):
            try:
                said += each(seed, tally)
            except Exception as error:  # whatever it is, the others are examined, too
                said.append(f"hunt: {name}: {type(error).__name__} {str(error)[:300]}")
    return seed, said, tally


def written(seed: int, text: str, folder: Path, heartbeats: bool, kind: str) -> Path:
    """The smallest description about which something of this kind is said, beside what is said."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"seed-{seed}-{sum(1 for _ in folder.glob(f'seed-{seed}-*.yaml'))}.yaml"
    false = partial(false_claims, heartbeats=heartbeats, runs=RUNS.get(kind, ()))
    content = shrunk(DESCRIPTIONS.get(kind, random_description)(seed), false, kind_of(text))
    said = [f"# {each}" for each in false(content)]
    path.write_text("\n".join([*said, yaml.safe_dump(content, sort_keys=False, default_flow_style=None, width=130)]))
    return path


def _results(each: Callable[[int], Found], seeds: range, jobs: int) -> Iterator[Found]:
    if jobs == 1:
        yield from map(each, seeds)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(each, seeds, chunksize=10)


def main() -> None:
    """Print what is said falsely, each kind once, then what was examined."""
    parser = argparse.ArgumentParser(
        prog="opponent.hunt_executors", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", default="0..100", metavar="FROM..TO", help="the last one is not included")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", choices=("all", "calls", *DESCRIPTIONS), default="all")
    parser.add_argument("--out", type=Path, help="folder for the smallest descriptions")
    parser.add_argument("--without-heartbeats", action="store_true", help="of the middleware, in simulations")
    arguments = parser.parse_args()
    heartbeats = not arguments.without_heartbeats
    first, end = map(int, arguments.seeds.split(".."))
    total, kinds, failing, begin = Tally(), Counter[str](), 0, time.monotonic()
    for seed, said, tally in _results(partial(hunt, arguments.only, heartbeats), range(first, end), arguments.jobs):
        total.add_all(tally)
        failing += bool(said)
        for kind, text in {kind_of(text): text for text in reversed(said)}.items():
            kinds[kind] += 1
            if kinds[kind] == 1:
                print(f"seed {seed}: {text}", flush=True)  # noqa: T201
                if arguments.out and not text.startswith(("calls", "hunt")):
                    print(f"    {written(seed, text, arguments.out, heartbeats, arguments.only)}", flush=True)  # noqa: T201
    print(total.table())  # noqa: T201
    print("\n".join(f"{count:6} x {kind}" for kind, count in kinds.most_common()))  # noqa: T201
    print(total.summary())  # noqa: T201
    print(f"{failing} failing seeds of {end - first}, {time.monotonic() - begin:.0f} s")  # noqa: T201


if __name__ == "__main__":
    main()
