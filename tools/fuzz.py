"""Look for files that break a command: mutated models and descriptions, and what must hold for each of them.

Usage: python tools/fuzz.py [--seconds N] [--seed S] [--jobs J] [--corpus FOLDER]... [--out FOLDER] [FILE]...

The same seed and files give the same cases, in the same order. Each cause of failures is reported once, with a file that is as small as
delta debugging makes it in a minute. With FILEs: only these are examined, as they are. The exit code is 1 if something fails.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from itertools import count
from pathlib import Path

from fuzzing.cases import Case, make_case, starting_points
from fuzzing.sandbox import Failure, failures, prepare
from fuzzing.shrinking import shrunk
from templating import ROOT

_SHRINKING_SECONDS = 60
_CORPUS = ROOT.parent / "shared" / "corpus"


def main() -> None:
    options = _options()
    prepare([_of_file(ROOT / "samples" / f"bodas-test-advanced{suffix}") for suffix in (".yaml", ".amxmi")])
    cases = map(_of_file, options.files) if options.files else _cases(options)
    known: set[tuple[str, str]] = set()
    examined = 0
    for case, found in failures(cases, options.jobs):
        examined += 1
        for failure in found:
            cause = (failure.invariant, failure.reason)
            if cause not in known:
                known.add(cause)
                _report(case if options.files else _shrunk(case, failure), failure, options.out, len(known))
    print(f"{examined} cases, {len(known)} failures")
    sys.exit(1 if known else 0)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument(
        "--corpus", type=Path, action="append", default=[_CORPUS], help="further folder with files to start from"
    )
    parser.add_argument("--out", type=Path, default=Path("build/fuzz"), help="folder for the files that fail")
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    return parser.parse_args()


def _of_file(path: Path) -> Case:
    return Case(path.name, path.read_bytes())


def _cases(options: argparse.Namespace) -> Iterator[Case]:
    files = starting_points(options.corpus)
    end = time.monotonic() + options.seconds
    for number in count():
        if time.monotonic() > end:
            return
        yield make_case(number, options.seed, files)


def _shrunk(case: Case, failure: Failure) -> Case:
    end = time.monotonic() + _SHRINKING_SECONDS

    def still_fails(smaller: Case) -> bool:
        if time.monotonic() > end:
            return False
        ((_, found),) = failures([smaller], 1)
        return any((other.invariant, other.reason) == (failure.invariant, failure.reason) for other in found)

    return shrunk(case, still_fails)


def _report(case: Case, failure: Failure, out: Path, number: int) -> None:
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"{failure.invariant}-{number}{Path(case.name).suffix}"
    path.write_bytes(case.content)
    print(f"{failure.invariant}: {failure.reason}: {failure.message}\n  python tools/fuzz.py {path}", flush=True)


if __name__ == "__main__":
    main()
