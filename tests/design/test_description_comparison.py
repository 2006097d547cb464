"""Two descriptions compared by what people wrote."""

from command import amuros as run_amuros
from support import ROOT

import amalthea_uros as amuros

SAMPLE = ROOT / "samples" / "esp32-serial.yaml"


def differences(tmp_path, *replacements):
    text = SAMPLE.read_text(encoding="utf-8")
    for old, new in replacements:
        assert text.count(old) == 1
        text = text.replace(old, new)
    target = tmp_path / "new.yaml"
    target.write_text(text, encoding="utf-8")
    return [(each.target, each.before, each.after) for each in amuros.diff(SAMPLE, target).described]


def test_values_are_compared(tmp_path):
    assert differences(
        tmp_path,
        ("sleep: 10 ms", "sleep: 1 ms"),
        ("baud_rate: 115200", "baud_rate: 460800"),
        ("rate: 20 Hz", "rate: 25 Hz"),
        ("{name: Encoders, period: 10 ms", "{name: Encoders, period: 5 ms"),
    ) == [
        ("uros_task.sleep", "10 ms", "1 ms"),
        ("serial.baud_rate", "115200", "460800"),
        ("On_Cmd_Vel.rate", "20 Hz", "25 Hz"),
        ("Encoders.period", "10 ms", "5 ms"),
    ]


def test_a_value_that_only_one_states_is_compared_with_that_of_the_platform(tmp_path):
    # The driver of the platform writes without ticks.
    assert differences(tmp_path, ("baud_rate: 115200,", "baud_rate: 115200, driver: {write: polling},")) == [
        ("driver.write", "blocking", "polling")
    ]


def test_another_board_is_one_difference(tmp_path):
    assert differences(tmp_path, ("platform: esp32", "platform: esp32-s3")) == [("hardware.platform", "esp32", "esp32-s3")]


def test_the_spelling_of_a_value_makes_no_difference(tmp_path):
    assert differences(tmp_path, ("sleep: 10 ms", "sleep: 10000 us")) == []


def test_objects_are_added_and_removed(tmp_path):
    target = tmp_path / "new.yaml"
    text = SAMPLE.read_text(encoding="utf-8").replace("name: Encoders", "name: Counters").replace("sleep: 10 ms", "sleep: 1 ms")
    target.write_text(text, encoding="utf-8")
    run = run_amuros("diff", SAMPLE, target)
    assert run.returncode == 1
    assert [line.strip() for line in run.stdout.splitlines() if line] == [
        "+ tasks.Counters",
        "- tasks.Encoders",
        "uros_task.sleep: 10 ms -> 1 ms",
        "3 differences of the descriptions",
    ]


def test_models_are_compared_by_their_objects():
    assert amuros.diff(SAMPLE, SAMPLE.with_suffix(".amxmi")).described == ()
