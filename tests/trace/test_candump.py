"""Logs of candump: each form of `candump.c` and `lib.c` of can-utils, damaged ones, and clocks that step."""

import gzip
import re
from itertools import accumulate, pairwise
from random import Random

import pytest
from can_frames import DATA, ERROR, EXTENDED, GAP, MS, REMOTE, SECOND, US, read, rows, rules
from hypothesis import example, given
from hypothesis import strategies as st

from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.trace.can.candump_lines import parse, read_lines
from amalthea_uros.trace.can.frames import XL
from amalthea_uros.trace.can.logs import open_can_log

HEAD = "(1436509052.000000) can0 "


def line(time: int, channel: str = "can0", frame: str = "123#11") -> str:
    """A line at a time in microseconds."""
    return f"({1436509052 + time // 10**6}.{time % 10**6:06}) {channel} {frame}\n"


@pytest.fixture
def log(tmp_path):
    return lambda content, name="run.log", **options: read(tmp_path / name, content, **options)


@pytest.mark.parametrize(
    ("frame", "expected"),
    [
        ("123#11223344", (0x123, DATA, "11223344")),
        ("123#", (0x123, DATA, "")),
        ("12345678#1122", (0x12345678 | EXTENDED, DATA, "1122")),
        ("00000123#1122", (0x123 | EXTENDED, DATA, "1122")),
        ("7ff#aabbccddeeff0011", (0x7FF, DATA, "AABBCCDDEEFF0011")),
        ("123#11.22.33", (0x123, DATA, "112233")),
        ("123#1122334455667788_B", (0x123, DATA, "1122334455667788")),
        ("123#R", (0x123, REMOTE, "")),
        ("123#R8", (0x123, REMOTE, "")),
        ("123#R8_9", (0x123, REMOTE, "")),
        ("123##0112233", (0x123, DATA, "112233")),
        ("123##4112233", (0x123, DATA, "112233")),
        ("12345678##F" + "5A" * 64, (0x12345678 | EXTENDED, DATA, "5A" * 64)),
        ("00123#81:01:0000ABCD#11223344556677889900", (0x123 | XL, DATA, "11223344556677889900")),
        ("20000080#0000000000000000", (0x80, ERROR, "00" * 8)),
        ("20000004#0004000000000000", (0x4, ERROR, "0004000000000000")),
        ("20000004#0001000000000000", (0, GAP, "0001000000000000")),  # receive overflow: frames are lost
        ("123#1122 R", (0x123, DATA, "1122")),
        ("123#1122 T", (0x123, DATA, "1122")),
        ("123##51122 T", (0x123, DATA, "1122")),
    ],
)
def test_the_frames_of_log_files(log, frame, expected):
    identifier, kind, data = expected
    [row], _ = log(f"{HEAD}{frame}\n")
    assert row == (0, "can0", identifier, kind, bytes.fromhex(data))


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (" (1436509052.249713)  can0  123   [4]  11 22 33 44", (0x123, DATA, "11223344")),
        (" (1436509052.249713)    can0       123   [2]  11 22", (0x123, DATA, "1122")),
        (" (1436509052.249713)  can0  12345678   [0] ", (0x12345678 | EXTENDED, DATA, "")),
        (" (1436509052.249713)  can0  7FF   [1]  11", (0x7FF, DATA, "11")),
        (" (1436509052.249713)  can0  123   [8]  remote request", (0x123, REMOTE, "")),
        (
            " (1436509052.249713)  can0  123  [12]  11 22 33 44 55 66 77 88 99 AA BB CC",
            (0x123, DATA, "112233445566778899AABBCC"),
        ),
        (" (1436509052.249713)  can0  RX - -  123   [2]  11 22", (0x123, DATA, "1122")),
        (" (1436509052.249713)  can0  TX B E  123  [02]  11 22", (0x123, DATA, "1122")),
        (" (1436509052.249713)  can0  123   {B}  11 22 33 44 55 66 77 88", (0x123, DATA, "1122334455667788")),
        (" (1436509052.249713)  can0  123   [2]  11 41                     '.A'", (0x123, DATA, "1141")),
        (" (1436509052.249713)  can0  123   [2]  41`11                     `A.`", (0x123, DATA, "1141")),
        (" (1436509052.249713)  can0  123   [2]  00010001 01000001", (0x123, DATA, "1141")),
        (" (1436509052.249713)  can0  20000080   [8]  00 00 00 00 00 00 00 00   ERRORFRAME", (0x80, ERROR, "00" * 8)),
        (" \x1b[31m(1436509052.249713)  can0  123   [1]  11\x1b[0m", (0x123, DATA, "11")),
    ],
)
def test_the_lines_of_the_console(log, line, expected):
    identifier, kind, data = expected
    [row], found = log(line + "\n")
    assert row == (249713 * US, "can0", identifier, kind, bytes.fromhex(data))
    assert set(rules(found)) <= {"CAN004"}


@pytest.mark.parametrize(
    "line",
    [
        "garbage",
        "(1436509052.249713) can0",
        "(1436509052) can0 123#11",
        "(1436509052.249713) can0 1234#11",
        "(1436509052.249713) can0 823#11",  # 11 bits end at 7FF
        "(1436509052.249713) can0 40000000#11",
        "(1436509052.249713) can0 123#1",
        "(1436509052.249713) can0 123#112233445566778899",
        "(1436509052.249713) can0 123##4" + "00" * 65,
        "(1436509052.249713) can0 123#11G2",
        "(1436509052.249713) can0 123#11 X",
        "(14365o9052.249713) can0 123#11",
        "(1436509052.24971x) can0 123#11",
        " (1436509052.249713)  can0  123   [4]  11 22 33",
        " (1436509052.249713)  can0  123   [2]  11 22 33",
        " (2026-13-21 10:00:00.123456)  can0  123   [1]  11",
        "DROPCOUNT: dropped",
    ],
)
def test_other_lines_are_counted_and_the_rest_is_read(log, line):
    frames, found = log(f"{HEAD}123#11\n{line}\n{line}\n{HEAD}123#22\n")
    # Nobody knows what was in the line, so nothing may be paired across it.
    assert [(kind, data) for *_, kind, data in frames] == [(DATA, b"\x11"), (GAP, b""), (GAP, b""), (DATA, b"\x22")]
    [finding] = found.findings
    assert (finding.rule, finding.location.line, finding.location.text) == ("CAN001", 2, line)
    assert "(2 times, this is the first)" in finding.message


def test_frames_without_time_are_refused_with_what_to_do(log):
    frames, found = log(" can0  123   [1]  11\n")
    assert [kind for *_, kind, _ in frames] == [GAP]
    [finding] = found.findings
    assert "no time stamp" in finding.message
    assert "candump" in finding.help


FIRST = " (000.000000)  can0  123   [0] "


@pytest.mark.parametrize(
    ("lines", "times", "found"),
    [
        (
            ["(1700000000.000001) can0 123#", "(1700000000.999999) can0 123#", "(1700000001.000000) can0 123#"],
            *([US, 999999 * US, SECOND], []),
        ),
        # Nanoseconds of newer versions.
        (["(1700000000.000000001) can0 123#", "(1700000000.123456789) can0 123##4"], [1000, 123456789000], []),
        # Since the first frame, and differences, which are added up.
        ([FIRST, " (000.001234)  can0  123   [0] ", " (001.000000)  can0  123   [0] "], [0, 1234 * US, SECOND], []),
        ([FIRST, " (000.002000)  can0  123   [0] ", " (000.001000)  can0  123   [0] "], [0, 2 * MS, 3 * MS], ["CAN005"]),
        # Dates have no zone.
        (
            [" (2026-09-21 10:00:00.123456)  can0  123   [0] ", " (2026-09-21 11:00:00.000000)  can0  123   [0] "],
            *([123456 * US, 3600 * SECOND], ["CAN005"]),
        ),
    ],
    ids=["seconds", "nanoseconds", "since the first", "differences", "dates"],
)
def test_times_are_exact(log, lines, times, found):
    frames, opened = log("\n".join(lines) + "\n")
    assert [time for time, *_ in frames] == times
    assert rules(opened) == found
    assert opened.resolution == (1000 if times[0] == 1000 else US)


@pytest.mark.parametrize(
    "wrong", ["(1700000000.00005) can0 123#", "(1700000000.0000050) can0 123#", "(1700000000.000005000) can0 123#"]
)
def test_a_time_with_a_digit_more_or_less_is_damaged(log, wrong):
    """candump writes all times of a log with the same number of digits, so those after a missing one are at the wrong place."""
    frames, found = log(f"(1700000000.000001) can0 123#\n{wrong}\n(1700000000.000009) can0 123#\n")
    assert [(time, kind) for time, *_, kind, _ in frames] == [(US, DATA), (US, GAP), (9 * US, DATA)]
    assert (rules(found), found.resolution) == (["CAN001"], US)


def test_times_since_the_first_frame(log):
    frames, found = log(" (000.000000)  can0  123   [0] \n (000.001234)  can0  123   [0] \n (001.000000)  can0  123   [0] \n")
    assert [time for time, *_ in frames] == [0, 1234 * US, SECOND]
    assert rules(found) == []


def test_differences_are_added_up_and_that_is_told(log):
    frames, found = log(" (000.000000)  can0  123   [0] \n (000.002000)  can0  123   [0] \n (000.001000)  can0  123   [0] \n")
    assert [time for time, *_ in frames] == [0, 2 * MS, 3 * MS]
    assert rules(found) == ["CAN005"]


def test_dates_have_no_zone(log):
    frames, found = log(" (2026-09-21 10:00:00.123456)  can0  123   [0] \n (2026-09-21 11:00:00.000000)  can0  123   [0] \n")
    assert frames[1][0] - frames[0][0] == 3600 * SECOND - 123456 * US
    assert rules(found) == ["CAN005"]


def test_dropped_frames_are_a_gap_at_the_time_of_the_frame_before(log):
    frames, found = log(
        f"{HEAD}123#11\nDROPCOUNT: dropped 12 CAN frames on 'can0,123:7FF' socket (total drops 12)\n(1436509053.000000) can0 123#\n"
    )
    assert [(time, channel, kind) for time, channel, _, kind, _ in frames] == [
        *((0, "can0", DATA), (0, "can0", GAP), (SECOND, "can0", DATA))
    ]
    assert rules(found) == ["CAN003"]


def test_error_frames_of_the_controller_are_told_by_their_class(log):
    _, found = log(f"{HEAD}20000040#0000000000000000\n{HEAD}20000024#0004000000000000\n")
    assert [finding.message for finding in found.findings] == [
        "error frame: bus off",
        "error frame: problem of the controller, no acknowledgement",
    ]


@pytest.mark.parametrize("name", ["run.log", "run.LOG.gz"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_files_may_be_packed_and_from_other_systems(log, name, end):
    text = f"{HEAD}123#11{end}{end}(1436509053.000000)  can1 7FF#22 T{end}".encode()
    frames, found = log(gzip.compress(text) if name.endswith("gz") else b"\xef\xbb\xbf" + text, name)
    assert frames == [(0, "can0", 0x123, DATA, b"\x11"), (SECOND, "can1", 0x7FF, DATA, b"\x22")]
    assert rules(found) == []


def test_a_last_line_without_end_may_have_been_cut(log):
    frames, found = log(f"{HEAD}123#1122\n{HEAD}123#11")
    assert len(frames) == 1
    assert rules(found) == ["CAN002"]
    assert found.findings[0].location.line == 2


def test_a_damaged_packed_file_is_read_up_to_the_damage(log):
    packed = gzip.compress("".join(f"(1436509052.{number:06}) can0 123#\n" for number in range(100_000)).encode())
    frames, found = log(packed[: len(packed) // 2], "run.log.gz")
    assert 10_000 < len(frames) < 100_000
    assert "TRC006" in rules(found)


def test_a_file_without_lines_is_read_up_to_a_limit(tmp_path):
    path = tmp_path / "endless.log"
    path.symlink_to("/dev/zero")
    found = open_can_log(path)
    assert list(found) == []
    assert rules(found) == ["TRC002"]


def test_a_missing_file_and_an_unknown_format(tmp_path):
    with pytest.raises(ReadError):
        list(open_can_log(tmp_path / "missing.log"))
    with pytest.raises(InvalidArgumentError, match=r"'run\.txt'.*\.log, \.asc.*e\.g\. run\.log\.gz"):
        open_can_log(tmp_path / "run.txt")


def test_one_channel_can_be_chosen(log):
    text = f"{HEAD}123#11\n(1436509052.000000) can1 123#22\nDROPCOUNT: dropped 1 CAN frame on 'can1' socket (total drops 1)\n"
    frames, _ = log(text, channel="can0")
    assert frames == [(0, "can0", 0x123, DATA, b"\x11")]
    frames, found = log(text, channel="can7")
    assert frames == []
    assert "CAN007" in rules(found)
    assert "can0, can1" in found.findings[-1].message


def test_a_time_that_cannot_be_right_does_not_move_all_others(log):
    frames, found = log("(9999999999.000000) can0 123#\n" + f"{HEAD}123#\n" * 3 + "(0000000001.000000) can0 123##4\n")
    assert [(time, kind) for time, *_, kind, _ in frames] == [(0, GAP), (0, DATA), (0, DATA), (0, DATA), (0, GAP)]
    assert rules(found) == ["CAN001"]


def test_blocks_do_not_cut_lines(tmp_path):
    lines = (line(number, f"can{number % 3}", f"{number % 2048:03X}#{number:016X}") for number in range(60_000))
    frames, _ = read(tmp_path / "run.log", "".join(lines))
    assert rows(open_can_log(tmp_path / "run.log"))[-9:] == frames[-9:]
    assert [data for *_, data in frames] == [number.to_bytes(8, "big") for number in range(60_000)]
    assert [channel for _, channel, *_ in frames[:3]] == ["can0", "can1", "can2"]


FRAMES = st.one_of(
    st.builds("{:03X}#{}".format, st.integers(0, 0x7FF), st.binary(max_size=8).map(bytes.hex)),
    st.builds("{:08X}#{}".format, st.integers(0, 0x1FFFFFFF), st.binary(max_size=8).map(lambda data: data.hex().upper())),
)


@given(
    seconds=st.integers(0, 10**10 - 1),
    fraction=st.integers(0, 999999),
    channel=st.sampled_from(["can0", "  vcan12", "slcan0", "c"]),
    frame=FRAMES,
    direction=st.sampled_from(["", " R", " T"]),
    damage=st.one_of(st.none(), st.tuples(st.integers(0, 50), st.sampled_from(" #().09aAFRgZ_\t\x00"))),
)
@example(0, 0, "c", "123#", "", (20, "\t"))
@example(0, 0, "ch", "123#", "", (20, "\x1b"))
def test_columns_and_single_lines_are_read_alike(seconds, fraction, channel, frame, direction, damage):
    text = f"({seconds:010}.{fraction:06}) {channel} {frame}{direction}"
    if damage is not None:
        place, character = damage
        text = text[:place] + character + text[place + 1 :]
    names = []
    lines = read_lines(f"{text}\n".encode(), lambda name: names.append(name) or len(names) - 1)
    if not lines.is_plain[0]:
        assert damage is not None
        return
    line = parse(text)
    assert line.stamp.time == int(lines.seconds[0]) * SECOND + int(lines.fraction[0]) * 1000
    assert (line.channel, line.identifier, line.data) == (names[0], lines.identifier[0], lines.payloads()[0])
    assert line.kind is DATA


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


@given(content=st.binary(max_size=300) | st.text(max_size=80), packed=st.booleans())
def test_any_bytes(tmp_path_factory, content, packed):
    path = tmp_path_factory.mktemp("logs") / ("run.log.gz" if packed else "run.log")
    read(path, content)


@given(steps=st.lists(st.integers(-5, 5), max_size=30))
def test_a_gap_is_wherever_the_clock_steps_back(tmp_path_factory, steps):
    times = list(accumulate(steps, initial=500_000))
    frames, _ = read(tmp_path_factory.mktemp("logs") / "run.log", "".join(map(line, times)))
    # A step of one microsecond is within the resolution.
    expected = sum(later < earlier - 1 for earlier, later in pairwise(times))
    assert sum(kind is GAP for _, _, _, kind, _ in frames) == expected


def test_damaged_names_of_channels_are_bounded(tmp_path):
    frames, log = read(tmp_path / "run.log", "".join(f"(1436509052.000000) can{number} 123#\n" for number in range(2000)))
    assert sum(kind is not GAP for *_, kind, _ in frames) == 256
    assert told(log, "CAN001") == 2000 - 256
    # Of the channels with the most frames only a few pairs are compared.
    assert len(log.findings) <= 7


def test_a_step_back_is_a_gap_at_the_time_after_it(tmp_path):
    frames, log = read(tmp_path / "run.log", "".join(map(line, (0, 900_000, 100_000, 200_000))))
    assert [(time // MS, kind is GAP) for time, _, _, kind, _ in frames] == [
        *((0, False), (900, False), (100, True), (100, False), (200, False))
    ]
    assert [(finding.rule, finding.location.line) for finding in log.findings] == [("CAN009", 3)]


def test_frames_of_two_buses_need_not_be_in_the_order_of_their_times(tmp_path):
    frames, log = read(tmp_path / "run.log", line(0, "can0") + line(500, "can1", "7FF#") + line(200, "can0"))
    assert len(frames) == 3
    assert rules(log) == []


def test_a_step_between_two_blocks_is_found(tmp_path):
    text = "".join(line(number) for number in range(60_000))
    _, log = read(tmp_path / "run.log", text + text)
    [finding] = log.findings
    assert (finding.rule, finding.location.line) == ("CAN009", 60_001)


def test_a_pause_much_longer_than_all_others_is_told_and_not_judged(tmp_path):
    times = [*range(0, 10_000_000, 100_000), *range(20_000_000, 21_000_000, 100_000)]
    frames, log = read(tmp_path / "run.log", "".join(map(line, times)))
    assert len(frames) == len(times)
    [finding] = log.findings
    # From 9.9 s to 20 s.
    assert (finding.rule, finding.location.line) == ("CAN010", 101)
    assert "10.1 s" in finding.message
    _, log = read(tmp_path / "run.log", "".join(map(line, [0, 10_000_000, 30_000_000, 45_000_000])))
    assert rules(log) == []


def test_one_bus_on_two_channels_is_told(tmp_path):
    text = "".join(
        line(1000 * number + delay, channel, f"123#{number:04X}")
        for number in range(50)
        for channel, delay in (("can0", 0), ("can1", 30))
    )
    _, log = read(tmp_path / "run.log", text)
    [finding] = log.findings
    assert finding.rule == "CAN011"
    assert "50 equal frames" in finding.message
    _, log = read(tmp_path / "run.log", text, channel="can1")
    assert rules(log) == []


def test_two_buses_with_the_same_identifiers_are_told(tmp_path):
    text = "".join(
        line(1000 * number, channel, f"{identifier}#{payload}{number:02X}")
        for number in range(50)
        for channel, payload, identifier in (("can0", "AA", "123"), ("can1", "BB", "123"), ("can1", "CC", "124"))
    )
    _, log = read(tmp_path / "run.log", text)
    [finding] = log.findings
    assert finding.rule == "CAN011"
    assert "1 equal identifiers" in finding.message
