"""Hostile logs of candump: no exception, and every line is a frame or counted in a finding."""

import re
from itertools import pairwise
from random import Random

from can_frames import GAP, read
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.trace.can.logs import open_can_log

LINES = [
    "(1436509052.249713) can0 123#11223344",
    "(1436509052.249813)  can1 12345678#1122334455667788 R",
    "(1436509052.249813) can1 123##41122",
    "(1436509052.249913) can0 20000004#0001000000000000",
    "DROPCOUNT: dropped 12 CAN frames on 'can0' socket (total drops 12)",
    " (1436509053.123456)  can0  123   [4]  11 22 33 44",
    " (1436509053.123456)  can0  123   [4]  44`33`22`11   ERRORFRAME",
    " (000.001234)  can0  123   [0] ",
    " can0  123   [1]  11",
    " (2026-09-21 10:00:00.123456)  can0  123   [0] ",
]


def mutated(random: Random, line: str) -> str:
    characters = list(line)
    for _ in range(random.randrange(4)):
        place = random.randrange(len(characters) + 1)
        match random.randrange(4):
            case 0:
                del characters[place : place + random.randrange(1, 5)]
            case 1:
                characters.insert(place, chr(random.randrange(1, 256)))
            case 2:
                characters[place:] = characters[: random.randrange(1, 9)]
            case _:
                characters[place : place + 1] = random.choice(["9" * 20, "#", "(", "\x00", " ", "\u0663", "[99]"])
    return "".join(characters).replace("\n", "")


def told(log, rule) -> int:
    counts = [
        re.search(r"\((\d+) times, this is the first\)", finding.message) for finding in log.findings if finding.rule == rule
    ]
    return sum(int(count[1]) if count else 1 for count in counts)


def test_every_line_is_a_frame_or_in_a_finding(tmp_path):
    random = Random(7)
    lines = [mutated(random, random.choice(LINES)) for _ in range(4000)]
    written = [line for line in lines if line.strip("\r")]
    path = tmp_path / "run.log"
    path.write_text("\n".join(lines) + "\n", newline="")
    log = open_can_log(path)
    tables = list(log)
    rows = {line: kind for table in tables for line, kind in zip(table.line.tolist(), table.kind.tolist(), strict=True)}
    assert len(rows) == len(written)
    lost = sum(kind == GAP for kind in rows.values()) - told(log, "CAN003")
    assert len(rows) - lost > 100
    assert lost == told(log, "CAN001")


@given(content=st.binary(max_size=300), packed=st.booleans())
def test_any_bytes(tmp_path_factory, content, packed):
    path = tmp_path_factory.mktemp("logs") / ("run.log.gz" if packed else "run.log")
    read(path, content)


@given(steps=st.lists(st.integers(-5, 5), max_size=30))
def test_a_gap_is_wherever_the_clock_steps_back(tmp_path_factory, steps):
    times, time = [], 500_000
    for step in steps:
        time += step
        times.append(time)
    path = tmp_path_factory.mktemp("logs") / "run.log"
    frames, _ = read(path, "".join(f"(1436509052.{time:06}) can0 123#\n" for time in times))
    # A step of one microsecond is within the resolution.
    expected = sum(later < earlier - 1 for earlier, later in pairwise(times))
    assert sum(kind is GAP for _, _, _, kind, _ in frames) == expected


def test_damaged_names_of_channels_are_bounded(tmp_path):
    frames, log = read(tmp_path / "run.log", "".join(f"(1436509052.000000) can{number} 123#\n" for number in range(40_000)))
    assert sum(kind is not GAP for *_, kind, _ in frames) == 256
    assert told(log, "CAN001") == 40_000 - 256
    # Of the channels with the most frames only a few pairs are compared.
    assert len(log.findings) <= 7
