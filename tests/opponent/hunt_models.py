"""Looks for false answers about many random models.

`python -m opponent.hunt_models --seeds 0..20000 --jobs 2 --out FOLDER` with `tests` and `tools` on the path.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from statistics import median

from opponent.generator import nested_model
from opponent.models.claims import Tally, false_claims
from opponent.models.facts import facts_of
from opponent.models.generator import RandomModel, random_model, richer_model
from opponent.models.limits import limits_of, with_limits
from opponent.models.shrinking import kind_of, shrunk

Found = tuple[int, list[str], Tally]


Maker = Callable[[int], RandomModel]


def hunt(make: Maker, seed: int) -> Found:
    """The false answers about the model of a seed."""
    tally = Tally()
    try:
        return seed, false_claims(make(seed), tally), tally
    except Exception as error:  # whatever it is, the others are examined, too
        return seed, [f"hunt: {error!r}"], tally


def written(make: Maker, seed: int, text: str, folder: Path) -> Path:
    """The smallest model about which something of this kind is said, with all limits, beside what is said."""
    wanted = kind_of(text)
    model = shrunk(make(seed), false_claims, wanted)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"seed-{seed}-{sum(1 for _ in folder.glob(f'seed-{seed}-*.md'))}.amxmi"
    facts = facts_of(model.text, model.delays, model.constraints)
    path.write_text(with_limits(model.told()[0], facts, list(limits_of(facts))), encoding="utf-8")
    said = [found for found in false_claims(model) if kind_of(found) == wanted]
    path.with_suffix(".md").write_text("\n".join([f"seed {seed}, {', '.join(sorted(model.told()[1]))}", *said]) + "\n")
    return path


def summary(tally: Tally, failing: Counter[str]) -> str:
    """What was examined, readable."""
    lines = [f"{failing[kind]:5} x {kind}" for kind, _ in failing.most_common()]
    lines += [f"{count:5} not played: {reason}" for reason, count in tally.unplayable.most_common()]
    for name in sorted(tally.claims):
        ratio = f"{median(tally.ratios[name]):.3f}" if tally.ratios.get(name) else "-"
        lines.append(f"{tally.unknown[name]:6} of {tally.claims[name]:6} unknown, median observed/bound {ratio:>6}  {name}")
    lines += [f"{count:6} {kind}" for kind, count in sorted(tally.kinds.items())]
    limits = ", ".join(f"{count} {verdict}" for verdict, count in tally.limits.items())
    return "\n".join([*lines, f"{tally.models} models, {tally.limits.total()} limits tried one unit inside: {limits}"])


def _results(make: Maker, seeds: range, jobs: int) -> Iterator[Found]:
    if jobs == 1:
        yield from map(partial(hunt, make), seeds)
        return
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(partial(hunt, make), seeds, chunksize=10)


def main() -> None:
    """Print what is said falsely, each kind once with its smallest model, then what was examined."""
    parser = argparse.ArgumentParser(prog="opponent.hunt_models", description=__doc__)
    parser.add_argument("--seeds", default="0..1000", metavar="FROM..TO", help="the last one is not included")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=Path, help="folder for the smallest models")
    parser.add_argument("--shrink", type=int, default=1, metavar="N", help="smallest models of N failures of each kind")
    parser.add_argument("--nested", action="store_true", help="models with constructs nested in each other")
    parser.add_argument("--richer", action="store_true", help="models with constraints and further constructs")
    parser.add_argument("--always", default="", metavar="FEATURE[,FEATURE]", help="richer models that have these constructs")
    arguments = parser.parse_args()
    always = frozenset(filter(None, arguments.always.split(",")))
    make: Maker = nested_model if arguments.nested else random_model
    make = partial(richer_model, always=always) if arguments.richer or always else make
    first, end = map(int, arguments.seeds.split(".."))
    total, kinds, failing, begin = Tally(), Counter[str](), 0, time.monotonic()
    for seed, said, tally in _results(make, range(first, end), arguments.jobs):
        total.add_all(tally)
        failing += bool(said)
        for kind, text in list({kind_of(text): text for text in reversed(said)}.items())[::-1]:
            kinds[kind] += 1
            if kinds[kind] <= arguments.shrink:
                print(f"seed {seed}: {text}", flush=True)  # noqa: T201
        new = [text for text in said[:1] if kinds[kind_of(text)] <= arguments.shrink and not text.startswith("hunt")]
        for text in new if arguments.out else ():
            print(f"    {written(make, seed, text, arguments.out)}", flush=True)  # noqa: T201
    print(f"{summary(total, kinds)}\n{failing} failing models of {end - first}, {time.monotonic() - begin:.0f} s")  # noqa: T201


if __name__ == "__main__":
    main()
