"""Make samples/bodas-test-measured.log: what a debug bus of the thesis's controller may have shown for 0.2 s.

Task switches cost about 41 us at 1 kHz and 31 us at 50 Hz, as the empty tasks show; the executor takes 12 us net, and 25 us with a
message (S. R. Bappanadu, University of Stuttgart, 2022, sections 6.1 and 6.2). The times vary by a few microseconds at random.

Usage: python tools/make_measured_log.py [FILE]
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from random import Random

ROOT = Path(__file__).parent.parent
LOG = ROOT / "samples" / "bodas-test-measured.log"

#: Microseconds.
_DURATION, _EPOCH = 200_000, 1_650_000_000 * 10**6
_FAST, _SLOW = 1_000, 20_000
_COST_OF_FAST, _COST_OF_SLOW, _SPREAD = 41, 31, 1
#: The identifiers at starts; those at ends are the next ones.
_EXECUTOR, _FACTOR, _CONTROL, _EMPTY_FAST, _EMPTY_SLOW = (0x18000001 + 2 * number for number in range(5))


def main(path: Path = LOG) -> None:
    """Write the log."""
    path.write_text("".join(_line(*frame) for frame in sorted(_frames(Random(1)))))


def _frames(random: Random) -> Iterator[tuple[int, int, int]]:
    """Time, identifier and number of the job of each frame."""
    for job in range(_DURATION // _FAST):
        time = job * _FAST
        has_message = job % (_SLOW // _FAST) == 0
        tasks = [
            (_EXECUTOR, 25 if has_message else 12, _COST_OF_FAST),
            (_CONTROL, 4, _COST_OF_FAST),
            (_EMPTY_FAST, 0, _COST_OF_FAST),
        ]
        if has_message:
            tasks += [(_FACTOR, 2, _COST_OF_SLOW), (_EMPTY_SLOW, 0, _COST_OF_SLOW)]
        for identifier, net, cost in tasks:
            end = time + net + cost + random.randint(-_SPREAD, _SPREAD)
            number = job // (_SLOW // _FAST) if cost == _COST_OF_SLOW else job
            yield from ((time, identifier, number), (end, identifier + 1, number))
            time = end + 1


def _line(time: int, identifier: int, job: int) -> str:
    seconds, rest = divmod(_EPOCH + time, 10**6)
    return f"({seconds}.{rest:06}) can0 {identifier:08X}#{job % 256:02X}\n"


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
