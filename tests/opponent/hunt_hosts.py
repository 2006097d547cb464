"""Looks for response times and latencies of random hosts that are beyond their bounds.

`python -m opponent.hunt_hosts --seeds 0..10000 --jobs 2` with `tests` and `tools` on the path, e.g. `PYTHONPATH=.:tests:tools` in the
folder of the project. Each seed is a random host with one kind of executor and a distribution for which it exists; it is analysed,
and played tick by tick with several phases by players that share no code with the product. It prints each value beyond a bound and
each loss that was not announced, with its seed, and for each kind and rules of distributions the number of systems, the share of
callbacks with a bound, and the median and the maximum of bound/observed.
"""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from random import Random
from statistics import median

from played_computer import Play
from played_groups import Executor
from played_groups import play as play_groups
from played_host import Thread, play
from random_computers import random_computer
from random_hosts import arrivals, multi_threaded_system_of, phases, random_groups, random_threads, system_of

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.host import RosRelease
from amalthea_uros.perf.system import System

EARLY = tuple(each for each in RosRelease if each.keeps_batches)
LATE = tuple(each for each in RosRelease if not each.keeps_batches)
#: The kinds of executors with the distributions whose rules are the same.
RULES = {
    "single-threaded, foxy to iron": ("single", EARLY),
    "single-threaded, jazzy and rolling": ("single", LATE),
    "static, foxy to iron": ("batch", EARLY),
    "static, jazzy and rolling": ("first", LATE),
    "events": ("events", tuple(RosRelease)),
    "multi-threaded, foxy to iron": ("multi", EARLY),
    "multi-threaded, jazzy and rolling": ("multi", LATE),
    "all together, foxy to iron": ("all", EARLY),
    "all together, jazzy and rolling": ("all", LATE),
}
HORIZON, PLAYS = 800, 3

Times = dict[str, int]
#: Of one run: the longest times of callbacks, of chains by their last callbacks, and who has lost something.
Played = tuple[Times, Times, set[str]]


@dataclass
class Hunted:
    """What is found about a random host."""

    rules: str
    known: int = 0
    total: int = 0
    ratios: list[float] = field(default_factory=list)
    false: list[str] = field(default_factory=list)


def hunt(seed: int) -> Hunted:
    """Bounds and played times of the host of a seed."""
    rules = list(RULES)[seed % len(RULES)]
    kind, releases = RULES[rules]
    random = Random(f"hunt {seed}")
    release = random.choice(releases)
    if kind == "all":
        found = _of_all(random, release)
    else:
        found = _of_threads(random, release) if kind == "multi" else _of_one_thread(random, kind, release)
    return _compared(Hunted(rules), *found, seed)


def _of_all(random: Random, release: RosRelease) -> tuple[System, list[list[str]], Iterator[Played]]:
    system, paths = random_computer(random, release)

    def played() -> Iterator[Played]:
        rules = {each.name: (each.interval, each.jitter) for each in system.host.topics if each.interval}
        for _ in range(PLAYS):
            outside = {topic: arrivals(random, *rule, HORIZON) for topic, rule in rules.items()}
            play = Play(system.host, outside, random).until(HORIZON)
            yield play.own, {path[-1]: play.whole[tuple(path)] for path in paths}, play.lost

    return system, paths, played()


def _of_one_thread(random: Random, kind: str, release: RosRelease) -> tuple[System, list[list[str]], Iterator[Played]]:
    threads, sources, paths = random_threads(random, kind)

    def played() -> Iterator[Played]:
        for _ in range(PLAYS):
            is_ordered = release.keeps_batches
            fresh = [Thread(each.kind, each.priority, each.callbacks, is_ordered=is_ordered) for each in threads]
            for thread in fresh:
                thread.due = phases(random, thread.callbacks)
            outside = {topic: arrivals(random, *rule, HORIZON) for topic, rule in sources.items()}
            yield (*play(fresh, outside, HORIZON, random), set())

    return system_of(threads, sources, paths, release), paths, played()


def _of_threads(random: Random, release: RosRelease) -> tuple[System, list[list[str]], Iterator[Played]]:
    callbacks, groups, sources, paths, threads = random_groups(random)

    def played() -> Iterator[Played]:
        for _ in range(PLAYS):
            executor = Executor(callbacks, groups, threads, not release.keeps_batches, phases(random, callbacks))
            outside = {topic: arrivals(random, *rule, HORIZON) for topic, rule in sources.items()}
            yield (*play_groups(executor, outside, HORIZON, random), set())

    return multi_threaded_system_of(callbacks, groups, sources, paths, threads, release), paths, played()


def _compared(found: Hunted, system: System, paths: list[list[str]], played: Iterator[Played], seed: int) -> Hunted:
    analysis = analyze_system(system)
    handles = {handle.name: handle for executor in analysis.host for handle in executor.handles}
    own, whole = defaultdict[str, int](int), defaultdict[str, int](int)
    for responses, latencies, lost in played:
        for most, times in ((own, responses), (whole, latencies)):
            for name, time in times.items():
                most[name] = max(most[name], time)
        unannounced = (name for name in lost if handles[name].response.worst is not None and not handles[name].lost)
        found.false += [f"seed {seed}: {name} can lose something" for name in unannounced]
    for name, handle in handles.items():
        found.total += 1
        worst = handle.response.worst
        if worst is None or not own[name]:
            continue
        found.known += 1
        found.ratios.append(worst / own[name])
        if worst < own[name]:
            found.false.append(f"seed {seed}: {name} takes {own[name]}, and {worst} at most ({handle.response.method})")
    for path in paths:
        name = path[-1]
        bound = analysis.chains[name].worst_if_not_lost
        if bound is not None and not any(handles[each].lost for each in path) and whole[name] > bound:
            found.false.append(f"seed {seed}: the chain to {name} takes {whole[name]}, and {bound} at most")
    return found


def main() -> None:
    """Hunt in a range of seeds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="0..10000", help="first..end")
    parser.add_argument("--jobs", type=int, default=2)
    parsed = parser.parse_args()
    first, end = map(int, parsed.seeds.split(".."))
    systems, known, total = Counter[str](), Counter[str](), Counter[str]()
    ratios, false = defaultdict[str, list[float]](list), list[str]()
    with ProcessPoolExecutor(parsed.jobs) as pool:
        for number, found in enumerate(pool.map(hunt, range(first, end), chunksize=7), start=1):
            systems[found.rules] += 1
            known[found.rules] += found.known
            total[found.rules] += found.total
            ratios[found.rules] += found.ratios
            false += found.false
            for line in found.false:
                print(line, flush=True)  # noqa: T201
            if number % 500 == 0 or number == end - first:
                print(f"{number} systems, {len(false)} values beyond their bounds", flush=True)  # noqa: T201
                for rules, count in systems.items():
                    share, ratio = known[rules] / total[rules], ratios[rules]
                    print(f"| {rules} | {count:,} | {share:.0%} | {median(ratio):.2f} ({max(ratio):.1f}) |", flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
