"""Clocks that step, counters that start again, and buses that are recorded twice."""

from can_frames import GAP, US, read, rules


def line(time: int, channel: str = "can0", frame: str = "123#11") -> str:
    return f"({1436509052 + time // 10**6}.{time % 10**6:06}) {channel} {frame}\n"


def test_a_step_back_is_a_gap_at_the_time_after_it(tmp_path):
    frames, log = read(tmp_path / "run.log", line(0) + line(900_000) + line(100_000) + line(200_000))
    assert [(time, kind is GAP) for time, _, _, kind, _ in frames] == [
        (0, False),
        (900_000 * US, False),
        (100_000 * US, True),
        (100_000 * US, False),
        (200_000 * US, False),
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
