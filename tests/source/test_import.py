"""Sources -> descriptions: the samples beside their expected files, values that cannot be read, and hostile input."""

import pytest
from importing import rules
from support import ROOT

from amalthea_uros._internal.message_types import MessageType, length_of
from amalthea_uros.errors import ReadError
from amalthea_uros.services.import_code import import_code
from amalthea_uros.source.flaws import _POOLS
from amalthea_uros.source.scope import literal
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.read import read_description
from amalthea_uros.uros.profiles import profile_of

SAMPLES = ROOT / "samples" / "sources"
SOURCES = sorted(path for path in SAMPLES.iterdir() if path.suffix != ".yaml")
#: Rules that the comments of the samples and a look at them explain.
FLAWS = {
    "int32_publisher.c": {"IMP008", "IMP012"},
    "let_and_trigger.c": {"IMP014", "IMP021", "IMP022"},
    "multi_io.c": {"IMP006", "IMP011", "IMP012", "IMP013"},
    "ping_pong.c": {"IMP012", "IMP021"},
    "reconnection.ino": {"IMP018"},
    "parameter_server.c": {"IMP007"},
    "two_executors.cpp": {"IMP023"},
    "zephyr_main.c": {"IMP009"},
}
BODY = """
void main(void) {{
  check(rclc_node_init_default(&node, "n", "", &support));
  {0}
  check(rclc_executor_init(&executor, &support.context, 2, &allocator));
  {1}
}}
"""
TIMER = "check(rclc_timer_init_default(&timer, &support, {}, cb)); "
ADD = "check(rclc_executor_add_timer(&executor, &timer)); "
LOOP = "while (1) {{ rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); {} }}"


def imported(tmp_path, text, name="main.c"):
    (tmp_path / name).write_text(text)
    return import_code([tmp_path / name])


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.name)
def test_a_sample_becomes_the_file_beside_it(path):
    result = import_code([path])
    assert result.text == path.with_suffix(".app.yaml").read_text()
    assert rules(result) == FLAWS.get(path.name, set())


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.name)
def test_each_gap_is_an_error_and_nothing_else_is_wrong(path, tmp_path):
    result = import_code([path], tmp_path / "app.yaml")
    with pytest.raises(ReadError) as error:
        read_description(tmp_path / "app.yaml")
    assert {finding.rule for finding in error.value.findings} == {"IMP001"}
    assert len(error.value.findings) == result.gaps == result.text.count("TODO") - 1  # one is in the comment at its begin


def test_a_description_without_gaps_is_read(tmp_path):
    text = import_code([SAMPLES / "ping_pong.c"]).text
    values = {"frequency": "160 MHz", "baud_rate": "115200", "string": "20", "rate": "1 Hz"}
    for key, value in values.items():
        text = text.replace(f"{key}: TODO", f"{key}: {value}")
    (tmp_path / "app.yaml").write_text(text.replace(": TODO", ": 20 us"))
    description = read_description(tmp_path / "app.yaml")
    executor = description.middleware.executor
    assert executor.loop.spin_some == executor.loop.sleep == 10 * 10**9
    assert executor.order == ["on_timer", "on_ping", "on_pong"]
    assert description.application.nodes[0].timers[0].period == 2 * 10**12


@pytest.mark.parametrize(
    ("period", "expected"),
    [
        ("RCL_MS_TO_NS(20)", "20 ms"),
        ("1000 * 1000 * 5", "5 ms"),
        ("(int64_t) 0x7A120", "500 us"),
        ("RCL_MS_TO_NS(PERIOD / 3)", "3 ms"),
        ("RCL_MS_TO_NS(again)", "7 ms"),
        ("RCL_MS_TO_NS(changed)", "TODO"),
        ("RCL_MS_TO_NS(TWICE)", "TODO"),
        ("read_period()", "TODO"),
        ("1 / 0", "TODO"),
    ],
)
def test_a_period_is_what_constants_say(period, expected, tmp_path):
    head = "#define PERIOD 10\n#define TWICE 1\n#define TWICE 2\n"
    head += "static const int again = 7;\nint changed = 5;\nvoid f(void) { changed = 6; }\n"
    text = imported(tmp_path, head + BODY.format(TIMER.format(period), ADD + LOOP.format(""))).text
    assert f"period: {expected} #" in text


@pytest.mark.parametrize(
    ("sleep", "expected"),
    [
        ("usleep(2500);", "sleep: 2500 us"),
        ("usleep(5000); usleep(5000);", "sleep: 10 ms"),
        ("k_sleep(K_MSEC(4));", "sleep: 4 ms"),
        ("vTaskDelay(pdMS_TO_TICKS(30));", "sleep: 30 ms"),
        ("vTaskDelay(30 / portTICK_PERIOD_MS);", "sleep: 30 ms"),
        # How long a tick is, nobody says; and a sleep that is skipped sometimes is not a sleep of each round.
        ("vTaskDelay(3);", "sleep: TODO"),
        ("if (idle) { usleep(100); }", "sleep: TODO"),
        ("usleep(how_long());", "sleep: TODO"),
        # How often another loop in this one sleeps is unknown.
        ("while (wait) { usleep(100); }", "sleep: TODO"),
        ("do { usleep(100); } while (0);", "sleep: 100 us"),
    ],
)
def test_the_sleep_of_a_loop(sleep, expected, tmp_path):
    text = imported(tmp_path, BODY.format(TIMER.format("5000000"), ADD + LOOP.format(sleep))).text
    assert expected.replace("2500 us", "2.5 ms") in text


@pytest.mark.parametrize(("milliseconds", "expected"), [(30, "sleep: 30 ms"), (15, "sleep: 10 ms"), (5, "spin_some: 10 ms}")])
def test_a_delay_is_cut_to_whole_ticks(milliseconds, expected, tmp_path):
    # With a tick of 10 ms, pdMS_TO_TICKS(5) is 0: the loop does not sleep at all.
    loop = LOOP.format(f"vTaskDelay(pdMS_TO_TICKS({milliseconds}));")
    text = imported(tmp_path, "#define configTICK_RATE_HZ 100\n" + BODY.format(TIMER.format("5000000"), ADD + loop)).text
    assert expected in text


def test_code_that_is_not_compiled_is_left_out(tmp_path):
    text = BODY.format(TIMER.format("RCL_MS_TO_NS(5)"), ADD + LOOP.format(""))
    off = f"#if 0\n{text.replace('&timer', '&other')}#endif\n"
    result = imported(tmp_path, off + text)
    assert result.text.count("period:") == 1
    assert rules(result) <= {"IMP018"}


def test_a_header_with_a_guard_is_read(tmp_path):
    (tmp_path / "config.h").write_text("#ifndef CONFIG_H\n#define CONFIG_H\n#define PERIOD 40\n#endif\n")
    (tmp_path / "main.c").write_text(BODY.format(TIMER.format("RCL_MS_TO_NS(PERIOD)"), ADD + LOOP.format("")))
    assert "period: 40 ms" in import_code([tmp_path]).text


@pytest.mark.parametrize("number", ["9" * 5000, "-9223372036854775808", "1e400", "\u00b2"])
def test_numbers_that_no_computer_has_are_refused_in_words_or_left_as_a_gap(number, tmp_path):
    loop = f"for (long i = {number}; i < 3; ++i) {{ rclc_publisher_init_default(&p[i], &node, type, topics[i]); }}"
    (tmp_path / "main.c").write_text(BODY.format(TIMER.format(number), loop + ADD + LOOP.format(f"usleep({number});")))
    (tmp_path / "app.meta").write_text(
        f'{{"names": {{"x": {{"cmake-args": ["-DRMW_UXRCE_MAX_NODES={number}", "-DUCLIENT_UDP_TRANSPORT_MTU={number}"]}}}}}}'
    )
    assert "TODO" in import_code([tmp_path]).text


def test_build_options_decide_what_the_pools_hold(tmp_path):
    (tmp_path / "main.c").write_text(BODY.format(TIMER.format("5000000"), ADD + LOOP.format("usleep(1);")))
    (tmp_path / "app-colcon.meta").write_text(
        '{"names": {"rmw_microxrcedds": {"cmake-args": [ // few\n"-DRMW_UXRCE_MAX_NODES=3", "-DRMW_UXRCE_MAX_GUARD_CONDITION=0",]}}}'
    )
    result = import_code([tmp_path])
    assert "RMW_UXRCE_MAX_NODES: 3 # app-colcon.meta:2" in result.text
    assert rules(result) == {"IMP007"}
    assert result.findings[0].severity == "error"


def test_two_programs_are_not_mixed(tmp_path):
    for name in "ab":
        (tmp_path / f"{name}.c").write_text(BODY.format(TIMER.format("5000000"), ADD + LOOP.format("usleep(1);")))
    assert "IMP016" in {finding.rule for finding in import_code([tmp_path]).findings}


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        # The figures of Micro-XRCE-DDS: Int32 4, Int64 8, Twist 6 * 8, Imu 312 with an empty frame_id.
        ("std_msgs/msg/Int32", (4, 4, True)),
        ("std_msgs/msg/Int64", (8, 8, True)),
        ("geometry_msgs/msg/Twist", (48, 48, True)),
        ("sensor_msgs/msg/Imu", (312, None, False)),
        ("std_msgs/msg/Empty", (1, 1, True)),
        ("my_msgs/msg/Own", None),
    ],
)
def test_the_length_of_a_message(kind, expected):
    assert length_of(MessageType(*kind.split("/"))) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [("0x10", 16), ("010", 8), ("1'000UL", 1000), ("1e3", 1000), ("2.5", None), ("08", 8), ("9" * 5000, None), ("", None)],
)
def test_a_number_of_c(text, expected):
    assert literal(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "((((" * 5000,
        "{" * 20000,
        "int x = " + "1+" * 20000 + "1;",
        "#define A B\n#define B A\n" + BODY.format(TIMER.format("A"), ADD),
        BODY.format(TIMER.format("f(" * 3000 + ")" * 3000), ADD),
        "void a(void) { b(); } void b(void) { a(); rclc_executor_spin(&e); }",
        "\ufffd\x01\x02 rclc_node_init_default( \x1b[31m",
        "#if 1\n" * 3000 + BODY.format("", ""),
        "#else\n#endif\nrclc_node_init_default();",
        "".join(f"void f{n}(void) {{ f{n + 1}(); f{n + 1}(); }}\n" for n in range(60))
        + "void f60(void) { rclc_executor_spin(&e); }",
    ],
    ids=range(10),
)
def test_hostile_code_is_read_or_refused_in_words(text, tmp_path):
    result = imported(tmp_path, text)
    assert result.findings
    assert result.text.startswith("#")


@pytest.mark.parametrize(("content", "reason"), [(b"\0\1", "not text"), (b" " * (4 * 2**20 + 1), "larger than")])
def test_what_is_not_source_code_is_refused(content, reason, tmp_path):
    (tmp_path / "main.c").write_bytes(content)
    with pytest.raises(ReadError, match=reason):
        import_code([tmp_path])


def test_the_pools_of_the_import_are_those_of_the_middleware():
    """The room of source code knows no middleware, so it has the defaults once more."""
    table = profile_of(Middleware()).option_table
    assert {name: table[name].default for name in _POOLS} == {name: default for name, (default, _) in _POOLS.items()}
