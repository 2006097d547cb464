"""The shared programs with the facts that are expected of each; written by hand, like the programs."""

import pytest
from importing import VALUES, described, filled, rules
from support import SHARED

from amalthea_uros.errors import ReadError
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.import_code import import_code
from amalthea_uros.units import MILLISECOND as MS

FOLDER = SHARED / "vectors" / "import"
#: Program -> texts of the description, and rules of findings.
EXPECTED = {
    "two-executors-one-loop.c": (["- spin_some: 10 ms", "- {spin_some: 100 ms, executor: e2}"], {"IMP018"}),
    "publish-from-second-task.c": (["name: spin", "name: imu", "- publish: [imu]", "- sleep: 20 ms"], {"IMP013", "IMP023"}),
    "enum-bounds.cpp": (["topic: led/a", "topic: led/b", "name: led1_callback", "name: led2_callback"], set()),
    "getters.c": (["topic: out", "topic: cmd", "loop: {spin_some: 100 ms, sleep: 10 ms}"], set()),
    "hal-delay.c": (["priority: 5", "- spin_some: 1 ms", "- busy_wait: 10 ms"], {"IMP008"}),
    # Nobody says how long a tick is: 10 ms is the default, with which it does not sleep.
    "delay-below-tick.c": (["loop: {spin_some: 1 ms, sleep: TODO}", "tick: 10 ms"], {"IMP020"}),
    "reconnection.ino": (["loop: {spin_some: 100 ms}", "name: on_a", "name: on_b"], {"IMP007", "IMP018"}),
    "zephyr-usleep.c": (["loop: {spin_some: 10 ms, sleep: 1 ms}", "rtos: zephyr"], {"IMP020"}),
    "publisher-of-other-node.c": (["name: motor", "name: ticks", "publishes: [ticks]"], {"IMP018"}),
    "unallocated-string.ino": (["name: on_s", "name: on_j"], {"IMP007", "IMP021"}),
    "odometry-best-effort.ino": (["type: nav_msgs/msg/Odometry # 704 B", "bounds: {string: TODO}"], {"IMP022"}),
    "arduino-wifi.ino": (["tick: 1 ms", "port: arduino", "udp: {bitrate: TODO}", "sleep: 5 ms"], set()),
}
#: The one that publishes what cannot be sent.
TOO_LONG = "odometry-best-effort.ino"
pytestmark = pytest.mark.skipif(not FOLDER.exists(), reason="the programs are not at hand")


@pytest.mark.parametrize("name", EXPECTED)
def test_a_program_has_the_expected_facts(name):
    result = import_code([FOLDER / name])
    texts, expected = EXPECTED[name]
    assert [text for text in texts if text not in result.text] == []
    assert rules(result) - {"IMP012"} == expected


@pytest.mark.parametrize("name", EXPECTED)
def test_what_is_written_is_read_when_its_gaps_are_filled(name, tmp_path):
    if name == TOO_LONG:
        # Whatever its strings are.
        with pytest.raises(ReadError, match="at most 500 B can be sent best effort"):
            described(import_code([FOLDER / name]), tmp_path)
        return
    _, findings = described(import_code([FOLDER / name]), tmp_path)
    assert [each for each in findings if each.severity == "error"] == []


def test_two_executors_of_one_loop_delay_each_other(tmp_path):
    described(import_code([FOLDER / "two-executors-one-loop.c"]), tmp_path)
    (e1, _) = analyze_files(tmp_path / "app.yaml").analysis.executors
    # 100 ms are true: the wait of the other one; the rest is what both execute, tens of microseconds each as filled in.
    assert e1.handles["on_timer"].lateness.most > 100 * MS
    assert e1.handles["on_timer"].lost is not None


def test_a_gap_is_never_taken_for_a_value(tmp_path):
    import_code([FOLDER / "two-executors-one-loop.c"], tmp_path / "app.yaml")
    with pytest.raises(ReadError):
        analyze_files(tmp_path / "app.yaml")


#: Values with which every time on the way of a message is stated, those of a network excepted.
KNOWN = VALUES | {
    "execution_time": "100 us",
    "base": "20 us",
    "per_message": "5 us",
    "sleep": "5 ms",
    "transport": "{serial: {baud_rate: 115200}, acknowledgement: 2 ms}",
}
AGENT = "middleware:\n  agent: {to_controller: {min: 0.1 ms, max: 1 ms}, to_host: {min: 0.1 ms, max: 1 ms}}\n"
#: A callback has no bound where the delays of Wi-Fi are unknown.
WITHOUT_BOUND = {"arduino-wifi.ino": ["on_cmd"]}


@pytest.mark.parametrize("name", sorted(EXPECTED.keys() - {TOO_LONG}))
def test_every_callback_has_a_bound_unless_something_is_unknown(name, tmp_path):
    text = filled(import_code([FOLDER / name]).text, KNOWN)
    (tmp_path / "app.yaml").write_text(text.replace("middleware:\n", AGENT))
    handles = [handle for each in analyze_files(tmp_path / "app.yaml").analysis.executors for handle in each.handles]
    assert handles
    assert [each.name for each in handles if each.response.worst is None] == WITHOUT_BOUND.get(name, [])
