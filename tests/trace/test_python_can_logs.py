"""Logs in the formats that python-can reads; its writers are the oracle, and its reader of candump logs where it is right."""

import gzip
import importlib.util
from random import Random

import pytest
from can_frames import DATA, ERROR, EXTENDED, GAP, MS, REMOTE, SECOND, US, read, rows, rules

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.can import python_can as optional
from amalthea_uros.trace.can.logs import SUFFIXES, open_can_log

can = pytest.importorskip("can")

FORMATS = [suffix for suffix in SUFFIXES if suffix != ".mf4" or importlib.util.find_spec("asammdf")]
#: The steps of the times that python-can writes.
RESOLUTION = {".log": US, ".asc": US, ".blf": 1000, ".trc": US, ".mf4": US}
ASC = "date Mon Sep 21 10:00:00.000 am 2026\nbase hex  timestamps absolute\nno internal events logged\n"
TRC = ";$FILEVERSION=1.1\n;$STARTTIME=45000.5\n;\n"


def messages(count=200):
    """Frames at whole microseconds, of which the first 24 have all kinds of lengths and identifiers."""
    random, time = Random(3), 1_436_509_052_000_000
    found = []
    for number in range(count):
        time += random.randrange(20, 5000)
        is_extended = bool(number % 2)
        identifier = random.randrange(2**29 if is_extended else 2**11)
        data = random.randbytes(number % 9)
        found.append(
            can.Message(
                time / 10**6, arbitration_id=identifier, is_extended_id=is_extended, data=data, channel=number % 2, check=True
            )
        )
    return found


def write(path, frames):
    with can.Logger(path) as logger:
        for frame in frames:
            logger(frame)


@pytest.mark.parametrize("suffix", FORMATS)
def test_what_python_can_writes_is_read(tmp_path, suffix):
    sent = messages()
    path = tmp_path / f"run{suffix}"
    write(path, sent)
    log = open_can_log(path)
    received = rows(log)
    assert [(identifier, kind, data) for _, _, identifier, kind, data in received] == [
        (frame.arbitration_id | (EXTENDED if frame.is_extended_id else 0), DATA, bytes(frame.data)) for frame in sent
    ]
    # The distances are exact, however the format counts, apart from floating-point numbers that python-can writes itself.
    origin = round(sent[0].timestamp * 10**6) * US
    expected = [round(frame.timestamp * 10**6) * US - origin for frame in sent]
    slack = 1000 * 1000 if suffix == ".blf" else 0
    assert all(abs(time - received[0][0] - exact) <= slack for (time, *_), exact in zip(received, expected, strict=True))
    assert log.resolution == RESOLUTION[suffix]
    assert len({channel for _, channel, *_ in received}) == 2
    assert rules(log) == []


@pytest.mark.parametrize("suffix", [".asc", ".trc", ".blf"])
def test_packed_files_are_read(tmp_path, suffix):
    path = tmp_path / f"run{suffix}"
    write(path, messages(20))
    packed = tmp_path / f"run{suffix}.gz"
    packed.write_bytes(gzip.compress(path.read_bytes()))
    assert rows(open_can_log(packed)) == rows(open_can_log(path))


def test_a_log_of_candump_is_read_as_by_python_can(tmp_path):
    # Only what python-can reads correctly: no error frames but those of the bus, no frames of CAN FD with other flags.
    write(tmp_path / "run.log", messages(500))
    ours = rows(open_can_log(tmp_path / "run.log"))
    theirs = list(can.LogReader(tmp_path / "run.log"))
    assert [(identifier & ~EXTENDED, bytes(data), channel) for _, channel, identifier, _, data in ours] == [
        (message.arbitration_id, bytes(message.data), message.channel) for message in theirs
    ]
    origin = 1_436_509_052 * SECOND
    assert all(abs(time + origin - message.timestamp * SECOND) < US for (time, *_), message in zip(ours, theirs, strict=True))


@pytest.mark.parametrize("suffix", [".asc", ".blf"])
def test_remote_and_error_frames(tmp_path, suffix):
    path = tmp_path / f"run{suffix}"
    write(
        path,
        [
            can.Message(1.0, 0x123, is_extended_id=False, data=b"\x01"),
            can.Message(1.5, 0x123, is_extended_id=False, is_remote_frame=True, dlc=4),
            can.Message(2.0, is_error_frame=True),
        ],
    )
    log = open_can_log(path)
    assert [(kind, data) for *_, kind, data in rows(log)][:2] == [(DATA, b"\x01"), (REMOTE, b"")]
    assert rows(open_can_log(path))[2][2:4] == (0, ERROR)
    assert rules(log) == ["CAN004"]


@pytest.mark.parametrize(
    ("stamps", "line", "expected", "found"),
    [
        # Differences between lines are added up with those of other records.
        (
            "relative",
            "0.002000 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%",
            [(10, DATA), (32, DATA)],
            ["CAN005", "CAN006"],
        ),
        ("absolute", "0.011000 1  OverrunError", [(10, DATA), (11, GAP), (20, DATA)], ["CAN003"]),
    ],
)
def test_other_records_of_asc(tmp_path, stamps, line, expected, found):
    first, last = (f"   0.0{time}0000 1  123             Rx   d 1 11\n" for time in (1, 2))
    text = f"{ASC.replace('absolute', stamps)}{first}   {line}\n{last}End TriggerBlock\n"
    frames, log = read(tmp_path / "run.asc", text)
    assert [(time // MS, kind) for time, _, _, kind, _ in frames] == expected
    assert {channel for _, channel, *_ in frames} == {"1"}
    assert rules(log) == found


@pytest.mark.parametrize(
    ("name", "head", "good", "bad"),
    [
        ("run.asc", ASC, "   0.010000 1  123             Rx   d 1 11\n", "   0.010000 1  1G3             Rx   d 1 11\n"),
        ("run.asc", ASC, "   0.010000 1  123             Rx   d 1 11\n", "   0.010000 1  FFFFFFFFFFFFx   Rx   d 1 11\n"),
        ("run.trc", TRC, "     1)      10.0  Rx  0123  1  11\n", "     1)      10.0  Rx  0123  1  1G\n"),
        ("run.trc", TRC, "     1)      10.0  Rx  0123  1  11\n", "     1)      10.0  Rx  0823  1  11\n"),
        ("run.trc", TRC, "     1)      10.0  Rx  0123  1  11\n", "     1)      10.0  Rx\n"),
    ],
)
def test_a_line_on_which_python_can_fails_is_counted_and_the_rest_is_read(tmp_path, name, head, good, bad):
    frames, log = read(tmp_path / name, head + good + bad + good + bad + good)
    # Nobody knows what was in the line, so nothing may be paired across it.
    good_row, gap = (10 * MS, DATA, b"\x11"), (10 * MS, GAP, b"")
    assert [(time, kind, data) for time, *_, kind, data in frames] == [good_row, gap, good_row, gap, good_row]
    [finding] = log.findings
    assert finding.rule in ("CAN001", "CAN006")
    assert finding.location.line == head.count("\n") + 2
    assert "(2 times" in finding.message


def test_a_damaged_packed_file_is_read_up_to_the_damage(tmp_path):
    packed = gzip.compress((ASC + "   0.010000 1  123             Rx   d 1 11\n" * 5000).encode())
    frames, log = read(tmp_path / "run.asc.gz", packed[: len(packed) // 2])
    assert 0 < len(frames) < 5000
    assert rules(log) == ["TRC006"]


@pytest.mark.parametrize("suffix", FORMATS)
def test_damaged_files_are_findings(tmp_path, suffix):
    whole = tmp_path / f"whole{suffix}"
    write(whole, messages(60))
    content = whole.read_bytes()
    random = Random(5)
    for number in range(8 if suffix == ".mf4" else 40):
        damaged = bytearray(content[: random.randrange(len(content))] if number % 2 else content)
        for _ in range(random.randrange(20)):
            if damaged:
                damaged[random.randrange(len(damaged))] = random.randrange(256)
        frames, log = read(tmp_path / f"run{suffix}", bytes(damaged))
        assert len(frames) >= 60 or log.findings or not damaged or suffix in (".asc", ".trc")


@pytest.mark.parametrize("suffix", [".blf", ".mf4"])
@pytest.mark.parametrize("content", [b"", b"no such format", b"LOGG" + bytes(300)])
def test_a_file_of_another_format_is_told(tmp_path, suffix, content):
    if suffix not in FORMATS:
        pytest.skip("asammdf is not installed")
    frames, log = read(tmp_path / f"run{suffix}", content)
    assert frames == []
    assert "CAN008" in rules(log)


def test_a_packed_blf_file_of_an_unknown_method_of_compression_is_told(tmp_path):
    write(tmp_path / "run.blf", messages())
    packed = bytearray(gzip.compress((tmp_path / "run.blf").read_bytes()))
    packed[2] = 7  # 8 is the only method (RFC 1952)
    (tmp_path / "packed.blf.gz").write_bytes(packed)
    log = open_can_log(tmp_path / "packed.blf.gz")
    assert list(log) == []
    assert "TRC006" in [finding.rule for finding in log.findings]


def test_a_cut_blf_file_is_told(tmp_path):
    path = tmp_path / "run.blf"
    write(path, messages(60))
    _, log = read(path, path.read_bytes()[:-20])
    assert "CAN002" in rules(log)


def test_what_to_install_is_told(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "can", None)
    with pytest.raises(InvalidArgumentError, match=r"pip install amuros\[can\]"):
        optional.python_can()
    with pytest.raises(InvalidArgumentError, match=r"pip install amuros\[can\]"):
        list(open_can_log(tmp_path / "run.asc"))
