"""Files for the build of the firmware: the smallest that hold, and nothing that the check of such files does not find."""

import json
import re
import shutil
import subprocess

import pytest
import yaml
from effort import every
from support import ROOT

from amalthea_uros.errors import ReadError, WriteError
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.build import describe
from amalthea_uros.services.generate import check_colcon_meta, generate
from amalthea_uros.services.init import example_names
from amalthea_uros.services.report import compile_report
from amalthea_uros.uros.generated_files import texts_of

#: zenoh-pico has no pools.
SAMPLES = [
    ROOT / "samples" / f"{name}.yaml" for name in example_names() if name not in ("robot-zenoh", "robot-two-controllers")
]
RCLC = ROOT / "samples" / "rclc-in-executor.yaml"
#: Everything that an application can have, with settings that the figures depend on.
FULL = """
amuros: 1
name: full "*/ name
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {period: 10 ms}
  multithread: true
  reliable: {timeout: 200 ms}
  transport: {serial: {}}
  limits:
    UCLIENT_CUSTOM_TRANSPORT_MTU: 1 kB
    RMW_UXRCE_STREAM_HISTORY: 8
    RMW_UXRCE_GRAPH: true
    RMW_UXRCE_MAX_SUBSCRIPTIONS: 20
application:
  nodes:
    - name: node
      subscriptions:
        - name: A
          topic: a/long/name/of/a/topic/that/needs/more/than/usual/for/names
          message_size: 4 B
          interval: 10 ms
          execution_time: 2 us
        - {name: B, topic: b, message_size: 600 B, reliability: best-effort, interval: 10 ms, execution_time: 2 us}
      publishers:
        - {topic: p-q, message_size: 4 B}
        - {topic: p_q, message_size: 8 B}
      timers:
        - {name: T, period: 10 ms, execution_time: 2 us, publishes: [p-q, p_q]}
      services:
        - {name: Ask, rate: 1 Hz, request_size: 4 B, response_size: 4 B, execution_time: 2 us}
      parameter_server: {execution_time: 1 us, rate: 1 Hz}
      lifecycle: {execution_time: 1 us, rate: 1 Hz}
"""


@pytest.fixture
def full(tmp_path):
    path = tmp_path / "full.yaml"
    path.write_text(FULL)
    return path


def arguments(text):
    return [argument for package in json.loads(text)["names"].values() for argument in package["cmake-args"]]


def checked(app, text, folder):
    path = folder / "colcon.meta"
    path.write_text(text)
    return check_colcon_meta(app, path).findings


def rules(findings):
    return [finding.rule for finding in findings]


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.stem)
def test_what_is_generated_holds_and_nothing_in_it_can_be_smaller(sample, tmp_path):
    assert_smallest(sample, tmp_path)


def test_so_it_is_for_an_application_with_everything(full, tmp_path):
    assert_smallest(full, tmp_path)


def assert_smallest(app, folder):
    text = generate(app).texts["colcon.meta"]
    assert checked(app, text, folder) == ()
    numbers = [argument for argument in arguments(text) if re.fullmatch(r"-D\w+=[1-9]\d*", argument)]
    assert len(numbers) > 3
    for argument in every(2, numbers):
        name, _, value = argument.partition("=")
        findings = checked(app, text.replace(argument, f"{name}={int(value) - 1}"), folder)
        assert any(finding.severity in ("error", "warning") and name[2:] in finding.message for finding in findings), argument


def test_settings_that_are_described_are_kept(full):
    assert {
        "-DUCLIENT_CUSTOM_TRANSPORT_MTU=1000",
        "-DRMW_UXRCE_STREAM_HISTORY=8",
        "-DRMW_UXRCE_GRAPH=ON",
        "-DUCLIENT_PROFILE_MULTITHREAD=ON",
        "-DRMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT=200",
        "-DRMW_UXRCE_TRANSPORT=custom",
        "-DRMW_UXRCE_MAX_SUBSCRIPTIONS=2",
        # The longest name, a slash and a terminator.
        f"-DRMW_UXRCE_TOPIC_NAME_MAX_LENGTH={len('a/long/name/of/a/topic/that/needs/more/than/usual/for/names') + 2}",
    } <= set(arguments(generate(full).texts["colcon.meta"]))


def test_colcon_reads_what_is_generated(full):
    """colcon reads it as YAML; other tools as JSON."""
    text = generate(full).texts["colcon.meta"]
    assert yaml.safe_load(text) == json.loads(text)


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs a compiler")
@pytest.mark.parametrize(("language", "standard"), [("c", "c11"), ("c++", "c++11")])
def test_the_compiler_finds_a_library_with_smaller_pools(language, standard, full, tmp_path):
    generate(full, tmp_path / "out")
    config = tmp_path / "rmw_microxrcedds_c" / "config.h"
    config.parent.mkdir()
    values = [argument[2:].split("=") for argument in arguments((tmp_path / "out" / "colcon.meta").read_text())]
    numbers = {name: int(value) for name, value in values if value.isdigit()} | {"UXR_CONFIG_CUSTOM_TRANSPORT_MTU": 1000}

    def compiles(macros):
        config.write_text("".join(f"#define {name} {value}\n" for name, value in macros.items()))
        run = subprocess.run(
            ["gcc", f"-std={standard}", "-x", language, "-Wall", "-Werror", "-fsyntax-only", "-I", tmp_path, "-"],
            input='#include "out/amuros_limits.h"\n',
            capture_output=True,
            check=False,
            text=True,
        )
        return run.returncode == 0, run.stderr

    assert compiles(numbers) == (True, "")
    fine, errors = compiles(numbers | {"RMW_UXRCE_MAX_SERVICES": 11})
    # The service, six of the parameter server and five of the lifecycle.
    assert not fine
    assert "RMW_UXRCE_MAX_SERVICES: at least 12" in errors
    assert compiles(numbers | {"RMW_UXRCE_MAX_TOPICS": -1})[0]


def test_names_that_are_alike_in_c_stay_apart(full):
    header = generate(full).texts["amuros_limits.h"]
    assert "#define AMUROS_SIZE_P_Q 4 /* p-q */\n#define AMUROS_SIZE_P_Q_2 8 /* p_q */\n" in header


META = '{{"names": {{"rmw_microxrcedds": {{"cmake-args": [{}]}}, "microxrcedds_client": {{"cmake-args": [{}]}}}}}}'
#: What the example needs: one node, two subscriptions, a publisher, two timers.
ENOUGH = [f"-DRMW_UXRCE_MAX_{name}" for name in ("SERVICES=0", "CLIENTS=0", "PUBLISHERS=1", "SUBSCRIPTIONS=2", "HISTORY=2")]


def meta(*options, client=()):
    return META.format(*(", ".join(map(json.dumps, each)) for each in ((*ENOUGH, *options), client)))


@pytest.mark.parametrize(
    ("options", "client", "expected"),
    [
        ([], [], []),
        (["-DRMW_UXRCE_MAX_NODES=1", "-DRMW_UXRCE_TRANSPORT=custom"], ["-DUCLIENT_PROFILE_UDP=OFF", "-DUCLIENT_PIC=OFF"], []),
        (["-DRMW_UXRCE_MAX_PUBLISHERS:STRING=1"], [], ["GEN005"]),  # the same option again
        (["-DRMW_UXRCE_MAX_NODES=0"], [], ["GEN004"]),
        (["-DRMW_UXRCE_MAX_TOPICS=2"], [], ["GEN001"]),
        (["-DRMW_UXRCE_MAX_TOPICS=-1"], [], []),
        (["-DRMW_UXRCE_MAX_GUARD_CONDITION=1"], [], ["GEN001"]),
        (["-DRMW_UXRCE_MAX_GUARD_CONDITION=9"], [], ["GEN002"]),
        (["-DRMW_UXRCE_MAX_TIMERS=2"], [], ["GEN003"]),
        ([], ["-DUCLIENT_MIN_HEARTBEAT_TIME_INTERVALL=1"], ["GEN003"]),
        (["-DRMW_UXRCE_STREAM_HISTORY=5"], [], ["GEN004"]),
        (["-DRMW_UXRCE_MAX_NODES=one"], [], ["GEN004"]),
        (["-DRMW_UXRCE_MAX_NODES=" + "9" * 5000], [], ["GEN004"]),
        (["-DRMW_UXRCE_XML_BUFFER_LENGTH=400"], [], ["GEN005"]),
        (["-DRMW_UXRCE_STREAM_HISTORY_INPUT=4"], [], ["GEN005"]),
        ([], ["-DUCLIENT_UDP_TRANSPORT_MTU=1024"], ["GEN005"]),
        (["-DUCLIENT_CUSTOM_TRANSPORT_MTU=512"], [], ["GEN005"]),  # an option of the other package
        ([], ["-DUCLIENT_CUSTOM_TRANSPORT_MTU=1024"], ["GEN008"]),
        # A best-effort message of 320 B with 12 B of headers.
        ([], ["-DUCLIENT_CUSTOM_TRANSPORT_MTU=256"], ["GEN001"]),
        (["-DRMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT=10"], [], ["GEN008"]),
        (["-DRMW_UXRCE_NODE_NAME_MAX_LENGTH=5"], [], ["GEN001"]),  # "robot" with its terminator
        (["-DRMW_UXRCE_NODE_NAME_MAX_LENGTH=6"], [], []),
    ],
)
def test_a_file_of_somebody(options, client, expected, tmp_path):
    text = meta(*options, client=client)
    assert rules(checked(RCLC, text, tmp_path)) == expected


def test_without_a_value_the_default_counts(tmp_path):
    findings = checked(RCLC, '{"names": {}}', tmp_path)
    assert findings == ()  # 4 of each by default
    app = tmp_path / "app.yaml"
    timers = "".join(f"        - {{name: T{number}, period: 10 ms, execution_time: 1 us}}\n" for number in range(5))
    head = "amuros: 1\nname: a\nhardware: {platform: single-core, frequency: 100 MHz}\n"
    app.write_text(f"{head}application:\n  nodes:\n    - name: n\n      timers:\n{timers}")
    (finding,) = checked(app, '{"names": {}}', tmp_path)
    assert finding.message.startswith("RMW_UXRCE_MAX_GUARD_CONDITION is 4 by default, but the application needs 5")


def test_what_has_no_effect_in_a_description_need_not_be_in_a_file(tmp_path):
    app = tmp_path / "app.yaml"
    head = "amuros: 1\nname: a\nhardware: {platform: single-core, frequency: 100 MHz}\n"
    limits = "middleware: {transport: {udp: {bitrate: 10 Mbit/s}}, limits: {UCLIENT_CUSTOM_TRANSPORT_MTU: 2048 B}}\n"
    timers = "[{name: T, period: 10 ms, execution_time: 1 us}]"
    app.write_text(f"{head}{limits}application: {{nodes: [{{name: n, timers: {timers}}}]}}\n")
    assert "GEN008" not in rules(checked(app, '{"names": {}}', tmp_path))


def test_the_bytes_to_save(tmp_path):
    (finding,) = checked(RCLC, meta("-DRMW_UXRCE_MAX_WAIT_SETS=3"), tmp_path)
    assert finding.help == "Set it to 1 to save 56 B."  # 28 B each
    (finding,) = checked(RCLC, meta("-DRMW_UXRCE_MAX_HISTORY=5").replace('"-DRMW_UXRCE_MAX_HISTORY=2", ', ""), tmp_path)
    assert finding.help == f"Set it to 2 to save {3 * (512 * 4 + 64)} B."


def test_comments_that_colcon_takes_for_values(tmp_path):
    lines = ("[ # fine", ' "-DRMW_UXRCE_MAX_NODES=1", // lost', ' "-DRMW_UXRCE_MAX_HISTORY=2",]')
    text = '{"names": {"rmw_microxrcedds": {"cmake-args": ' + "\n".join(lines) + "}}}"
    assert yaml.safe_load(text)["names"]["rmw_microxrcedds"]["cmake-args"][1].startswith("// lost")
    (finding,) = checked(RCLC, text, tmp_path)
    assert (finding.rule, finding.location.line, finding.location.column) == ("GEN007", 2, 29)


@pytest.mark.parametrize(
    "text",
    [
        *(
            "",
            "{",
            "[]",
            "1",
            '{"names": 1}',
            '{"names"}',
            '{"names": {"a": }}',
            '{"names": {,}}',
            '{"names": {}} x',
            "\x00",
            '"\\x"',
        ),
        *(
            '{"names": {"a": {"cmake-args": ["-DA=1" "-DB=2"]}}}',
            "[" * 100_000,
            '{"a":' * 100_000,
            "/*" * 10_000,
            '"' + "\\" * 9_999,
        ),
    ],
    ids=lambda text: repr(text[:12]),
)
def test_what_is_no_colcon_meta(text, tmp_path):
    with pytest.raises(ReadError) as caught:
        checked(RCLC, text, tmp_path)
    assert rules(caught.value.findings) == ["GEN006"]


def test_settings_of_other_packages_and_forms_are_nothing_to_complain_about(tmp_path):
    text = """{"names": {
        "tracetools": {"cmake-args": ["-DTRACETOOLS_DISABLED=ON"]}, "rcutils": {"cmake-args": "x"}, "rcl": {}, "a": [1, null, {}],
        "rmw_microxrcedds": {"cmake-args": ["--no-warn-unused-cli", 5, "-DRMW_UXRCE_DEFAULT_UDP_PORT=8888"]}}}"""
    assert checked(RCLC, text, tmp_path) == ()


def test_large_files_are_checked_quickly(tmp_path):
    options = "\n".join(f'"-DRMW_UXRCE_MAX_NODE{number}=1", // x' for number in range(20_000))
    findings = checked(RCLC, META.format(options + "\n", ""), tmp_path)
    assert len(findings) == 100
    with pytest.raises(ReadError) as caught:
        checked(RCLC, " " * (2 << 20), tmp_path)
    assert "larger than" in caught.value.findings[0].message


def test_files_of_others_are_not_replaced(tmp_path):
    mine = tmp_path / "out" / "colcon.meta"
    mine.parent.mkdir()
    mine.write_text('{"names": {}}')
    with pytest.raises(WriteError) as caught:
        generate(RCLC, mine.parent)
    assert [finding.location.path for finding in caught.value.findings] == [mine]
    assert [path.name for path in mine.parent.iterdir()] == ["colcon.meta"]
    generate(RCLC, mine.parent, force=True)
    assert sorted(path.name for path in mine.parent.iterdir()) == ["amuros_limits.h", "colcon.meta"]
    generate(ROOT / "samples" / "drive-and-lift.yaml", mine.parent)  # replaces what it wrote itself
    assert "drive-and-lift" in mine.read_text()


def test_without_an_application_there_is_nothing_to_generate(tmp_path):
    app = tmp_path / "app.yaml"
    app.write_text(
        "amuros: 1\nname: a\nhardware: {platform: generic}\ntasks:\n  - {name: T, period: 1 ms, execution_time: 1 us}\n"
    )
    with pytest.raises(ReadError) as caught:
        generate(app)
    assert rules(caught.value.findings) == ["GEN009"]


def test_zenoh_has_options_for_cmake(tmp_path):
    app = tmp_path / "app.yaml"
    text = RCLC.read_text().replace(
        "middleware:\n", "middleware:\n  profile: zenoh-pico\n  tasks: [{name: zenoh_read, priority: 5}]\n"
    )
    app.write_text(text.replace("RMW_UXRCE_MTU: 512 B", "BATCH_UNICAST_SIZE: 1 kB, Z_FEATURE_BATCHING: false"))
    texts = generate(app).texts
    assert list(texts) == ["zenoh_options.cmake", "amuros_limits.h"]
    found = re.findall(r"^set\((\w+) (\d+) CACHE STRING", texts["zenoh_options.cmake"], re.MULTILINE)
    assert found == [("BATCH_UNICAST_SIZE", "1000"), ("Z_FEATURE_BATCHING", "0")]
    assert "rmw_microxrcedds" not in texts["amuros_limits.h"]


def test_results_are_tables(tmp_path):
    result = generate(RCLC, tmp_path)
    rows = {row["option"]: (row["generated"], row["described"]) for row in result.to_records()}
    assert rows["RMW_UXRCE_MAX_TOPICS"] == ("3", "8")
    assert "RMW_UXRCE_MAX_TOPICS" in str(result)
    check = check_colcon_meta(RCLC, tmp_path / "colcon.meta")
    assert (check.to_records(), check.is_fine) == ([], True)
    assert "holds for" in str(check)


def test_pools_of_a_board_that_are_too_small_are_no_obstacle(tmp_path):
    app = tmp_path / "app.yaml"
    publishers = "".join(
        f"        - {{topic: p{number}, message_size: 4 B, reliability: best-effort}}\n" for number in range(3)
    )
    # ESP-IDF has two publishers by default.
    head = "amuros: 1\nname: a\nhardware: {platform: esp32}\nmiddleware: {transport: {serial: {}}}\n"
    head += "application:\n  nodes:\n    - name: n\n"
    timers = "      timers: [{name: T, period: 100 ms, execution_time: 1 us, publishes: [p0, p1, p2]}]\n"
    app.write_text(f"{head}      publishers:\n{publishers}{timers}")
    result = generate(app)
    assert "-DRMW_UXRCE_MAX_PUBLISHERS=3" in arguments(result.texts["colcon.meta"])
    assert not {"UR120", "UR127"} & set(rules(result.findings))
    assert checked(app, result.texts["colcon.meta"], tmp_path) == ()


def test_a_history_that_the_build_refuses_is_not_generated(tmp_path):
    app = tmp_path / "app.yaml"
    app.write_text(RCLC.read_text().replace("limits: {", "limits: {RMW_UXRCE_STREAM_HISTORY: 3, "))
    text = generate(app).texts["colcon.meta"]
    assert "-DRMW_UXRCE_STREAM_HISTORY=4" in arguments(text)
    assert checked(app, text, tmp_path) == ()


LOOPING = [sample for sample in SAMPLES if "loop:" in sample.read_text()]


def slots(text):
    return int(re.search(r"-DRMW_UXRCE_MAX_HISTORY=(\d+)", text)[1])


def with_slots(text, number, folder):
    """A description with a number of slots for messages."""
    shutil.copy(ROOT / "samples" / "two-controllers.dbc", folder)
    option = f"RMW_UXRCE_MAX_HISTORY: {number}"
    text = re.sub(r"RMW_UXRCE_MAX_HISTORY: \d+", option, text)
    if option not in text and "  limits: {" in text:
        text = text.replace("  limits: {", f"  limits: {{{option}, ")
    elif option not in text:
        text = text.replace("\napplication:", f"\n  limits: {{{option}}}\napplication:", 1)
    app = folder / "slots.yaml"
    app.write_text(text)
    return app


@pytest.mark.parametrize("sample", LOOPING, ids=lambda path: path.stem)
def test_with_the_slots_that_are_generated_the_analysis_finds_no_message_without_one(sample, tmp_path):
    text = sample.read_text()
    number = slots(generate(sample).texts["colcon.meta"])
    app = with_slots(text, number, tmp_path)
    assert "EXE014" not in rules(analyze_files(app).findings)
    # What the description states changes nothing in what is needed; and the number is the smallest.
    assert slots(generate(app).texts["colcon.meta"]) == number
    assert number == 1 or "EXE014" in rules(analyze_files(with_slots(text, number - 1, tmp_path)).findings)


USB = (ROOT / "samples" / "stm32-usb-cdc.yaml").read_text()
KEPT_BACK = USB.replace("    order: ", "    trigger: all\n    order: ")


@pytest.mark.parametrize(
    ("text", "number", "why"),
    [
        # A publication that waits keeps rounds from taking messages, which come every 50 ms with jitter.
        (USB, 5, "as many as the analysis finds"),
        # Nothing is taken while the trigger is false: as many as a best-effort history keeps.
        (KEPT_BACK, 5, "all that are kept for On_Cmd_Vel, whose response time has no bound"),
        (KEPT_BACK.replace("topic: cmd_vel,", "topic: cmd_vel, depth: 7,"), 7, "all that are kept for On_Cmd_Vel"),
    ],
)
def test_messages_that_wait_are_counted_by_the_analysis(text, number, why, tmp_path):
    app = with_slots(text, 9, tmp_path)
    result = generate(app)
    row = next(row for row in result.to_records() if row["option"] == "RMW_UXRCE_MAX_HISTORY")
    assert row["generated"] == str(number)
    assert why in row["counts"]
    enough = result.texts["colcon.meta"]
    assert checked(app, enough, tmp_path) == ()
    stated = f"MAX_HISTORY={number}"
    (few,) = checked(app, enough.replace(stated, f"MAX_HISTORY={number - 1}"), tmp_path)
    assert few.rule == "GEN001"
    assert f"the application needs {number}: received messages that wait at the same time: " in few.message
    (many,) = checked(app, enough.replace(stated, f"MAX_HISTORY={number + 1}"), tmp_path)
    assert (many.rule, many.message) == ("GEN002", f"RMW_UXRCE_MAX_HISTORY is {number + 1}, but {number} would be enough")


@pytest.mark.parametrize(("described", "number"), [(1, 20), (30, 30)])
def test_an_executor_without_a_loop_leaves_the_number_open(described, number, tmp_path):
    app = tmp_path / "app.yaml"
    subscription = "execution_time: 10 us, rate: 10 Hz, message_size: 4 B"
    app.write_text(f"""amuros: 1
name: a
hardware: {{platform: esp32}}
middleware:
  executors: [{{name: A, loop: {{spin_some: 10 ms}}, priority: 4}}, {{name: B, period: 10 ms, priority: 5}}]
  limits: {{RMW_UXRCE_MAX_HISTORY: {described}}}
  transport: {{serial: {{}}}}
application:
  nodes:
    - name: n
      subscriptions: [{{name: S, topic: s, {subscription}}}, {{name: T, runs_in: B, topic: t, {subscription}}}]
""")
    # What the histories of both keep, 10 by default, or what the description has.
    text = generate(app).texts["colcon.meta"]
    assert slots(text) == number
    assert "no number is known to be enough because of B" in text


def test_a_number_without_an_analysis_is_a_lower_bound(tmp_path):
    two = USB.replace("      subscriptions:\n", "      subscriptions:\n        - {name: B, topic: b, SAME}\n")
    two = two.replace("SAME", "rate: 20 Hz, message_size: 4 B, execution_time: 1 us").replace(
        "On_Cmd_Vel]\n", "On_Cmd_Vel, B]\n"
    )
    two = two.replace("max_handles: 2", "max_handles: 3")
    (finding,) = [each for each in describe(with_slots(two, 1, tmp_path)).findings if each.rule == "UR120"]
    assert finding.message == "RMW_UXRCE_MAX_HISTORY is 1, but the application needs at least 2"
    assert "Set RMW_UXRCE_MAX_HISTORY to the number that 'amuros generate' computes" in finding.help


def test_a_report_has_the_file_that_is_generated(tmp_path):
    content = compile_report(with_slots(USB, 4, tmp_path), with_simulation=False)
    assert slots(texts_of(content.assembly)["colcon.meta"]) == 5
