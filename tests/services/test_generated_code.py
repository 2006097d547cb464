"""The C that is written for a description: imported again, it is what it was written from; it compiles; its stamps are measured."""

import re
import subprocess
from pathlib import Path

import pytest
from support import ROOT

from amalthea_uros.errors import ReadError
from amalthea_uros.services.build import describe
from amalthea_uros.services.generate import check_colcon_meta, generate
from amalthea_uros.services.import_code import import_code
from amalthea_uros.services.measure import measure
from amalthea_uros.spec.read import read_description
from amalthea_uros.units import MICROSECOND as US

#: Code is that of one controller.
SAMPLES = [
    path
    for path in sorted((ROOT / "samples").glob("*.yaml"))
    if "loop:" in path.read_text() and path.stem != "robot-two-controllers"
]
APP = """
amuros: 1
name: app
hardware: {{platform: generic, frequency: 100 MHz}}
{os}
middleware:
  {port}
  executors:
    - name: first
      {thread}
      max_handles: 20
      loop: {loop}
      order: [on_scan, control, on_mode, on_answer, wake, on_move, on_done]
    {second}
  transport: {{serial: {{baud_rate: 115200}}}}
  limits: {{{limits}}}
application:
  nodes:
    - name: robot
      publishers:
        - {{topic: odom, type: geometry_msgs/msg/Pose2D, reliability: best-effort}}
        - {{topic: raw, message_size: 17 B}}
      subscriptions:
        - {{name: on_scan, topic: scan, type: std_msgs/msg/String, bounds: {{string: 30}}, TIMES, reliability: best-effort}}
        - {{name: on_wheel, topic: wheel, type: std_msgs/msg/Int32, TIMES, runs_in: {wheel}}}
      timers: [{{name: control, period: 20 ms, execution_time: 1 ms, publishes: [odom, raw], requests: [on_answer]}}]
      services: [{{name: on_mode, type: std_srvs/srv/SetBool, bounds: {{string: 9}}, TIMES}}]
      clients: [{{name: on_answer, service: ask, request_size: 3 B, response_size: 5 B, TIMES}}]
      guard_conditions: [{{name: wake, TIMES}}]
      action_servers: [{{name: on_move, goal_size: 20 B, result_size: 6 B, feedback_size: 18 B, TIMES}}]
      action_clients: [{{name: on_done, action: fetch, goal_size: 20 B, result_size: 6 B, feedback_size: 18 B, TIMES}}]
      parameter_server: {{rate: 1 Hz, execution_time: 1 ms}}
""".replace("TIMES", "rate: 1 Hz, execution_time: 1 ms")
LIFECYCLE = "{rate: 1 Hz, execution_time: 1 ms}"
LIMITS = ", ".join(f"RMW_UXRCE_MAX_{each}: 30" for each in ("PUBLISHERS", "SUBSCRIPTIONS", "SERVICES", "CLIENTS", "HISTORY"))
THREAD = "priority: 4, stack: 9000 B"
#: Port -> operating system, and the loop of its first thread.
PORTS = {
    "arduino": ("", "[{spin_some: 10 ms}, {busy_wait: 3 ms}, {publish: [raw]}]"),
    "platformio": ("os: {rtos: freertos, tick: 1 ms}", "{spin_some: 10 ms}"),
    "espidf": ("os: {rtos: freertos, tick: 1 ms}", "[{ping: 100 ms}, {spin_some: 10 ms}, {sleep: 5 ms}, {busy_wait: 0.5 ms}]"),
    "zephyr": ("os: {rtos: zephyr}", "{spin_some: 10 ms, sleep: 2.5 ms}"),
    "cubemx": ("os: {rtos: freertos, tick: 1 ms}", "[{spin_some: 10 ms}, {busy_wait: 3 ms}, {sync: 1 s}]"),
    "renesas": ("os: {rtos: freertos, tick: 1 ms}", "{spin_period: 10 ms, timeout: 2 ms}"),
    "freertos": ("os: {rtos: freertos, tick: 1 ms}", "{spin_some: 1 ms, sleep: 3 ms}"),
    "pico-sdk": ("", "{spin_some: 10 ms, sleep: 0.25 ms}"),
    "nuttx": ("os: {rtos: nuttx}", "{spin: 50 ms}"),
}
#: What the code calls, with its parameters.
STUBS = Path(__file__).parent / "rclc_stubs.h"
WITH_THREADS = ("espidf", "zephyr", "cubemx", "renesas", "freertos")


def stated(section):
    """The keys of a section that have a value."""
    every = {name: getattr(section, name) for name in type(section).model_fields}
    return {name: value for name, value in every.items() if value is not None}


def described(port, folder):
    os, loop = PORTS[port]
    has_threads = port in WITH_THREADS
    second = "- {name: second, priority: 3, stack: 8000 B, loop: {spin_some: 5 ms, sleep: 5 ms}}" if has_threads else ""
    values = {"os": os, "loop": loop, "second": second, "limits": LIMITS, "wheel": "second" if has_threads else "first"}
    thread = "priority: 4\n      stack: 9000 B" if has_threads else "priority: 4"
    (folder / "app.yaml").write_text(APP.format(port=f"ros: iron\n  port: {port}", thread=thread, **values))
    return folder / "app.yaml"


def imported(folder, original):
    """The description of code, whose gaps have what the code cannot tell."""
    text = import_code([folder]).text
    for key, value in (
        ("base", "1 us"),
        ("per_message", "1 us"),
        ("rate", "1 Hz"),
        ("frequency", "100 MHz"),
        ("execution_time", "1 ms"),
    ):
        text = text.replace(f"{key}: TODO", f"{key}: {value}")
    text = text.replace("transport: TODO", "transport: {serial: {baud_rate: 115200}}")
    strings = iter(re.findall(r"bounds: \{string: (\d+)", original.read_text()))
    text = re.sub(r"string: TODO", lambda _: f"string: {next(strings)}", text)
    (folder / "again.yaml").write_text(text)
    return read_description(folder / "again.yaml")


def loop_of(loop):
    """A loop in one form, whichever way it is written; where its rounds begin does not matter."""
    if loop is None:
        return None
    if loop.items is not None:
        items = [tuple(stated(each).items()) for each in loop.items]
        items = [tuple((k, tuple(v) if isinstance(v, list) else v) for k, v in each) for each in items]
    elif loop.spin_some is not None:
        items = [(("spin_some", loop.spin_some),), *([(("sleep", loop.sleep),)] if loop.sleep else [])]
    else:
        return loop.spin_period, loop.timeout, loop.spin
    return min(items[turn:] + items[:turn] for turn in range(len(items)))


def facts(description, has_threads=True):
    """Everything in a description that code has, too."""
    nodes, middleware = description.application.nodes, description.middleware
    executors = middleware.executors or [middleware.executor]
    return {
        "nodes": [node.name for node in nodes],
        "publishers": {(p.topic, p.message_size, p.reliability) for node in nodes for p in node.publishers},
        "subscriptions": {
            (s.name, s.topic, s.message_size, s.reliability, s.invocation) for node in nodes for s in node.subscriptions
        },
        "timers": {(t.name, t.period or 10**12 // t.rate, *t.publishes, *t.requests) for node in nodes for t in node.timers},
        "services": {(s.name, s.request_size, s.response_size) for node in nodes for s in node.services},
        "clients": {(c.name, c.service, c.request_size, c.response_size) for node in nodes for c in node.clients},
        "guards": {guard.name for node in nodes for guard in node.guard_conditions},
        "actions": {(a.name, a.goal_size, a.result_size, a.feedback_size) for node in nodes for a in node.action_servers},
        "action_clients": {
            (a.name, a.action, a.goal_size, a.result_size, a.feedback_size) for node in nodes for a in node.action_clients
        },
        "servers": [node.parameter_server is not None for node in nodes],
        "loops": [(each.name, loop_of(each.loop)) for each in executors],
        "threads": [(each.priority, each.stack) for each in executors] if has_threads else [],
    }


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda path: path.stem)
def test_the_code_of_a_sample_is_imported_as_what_it_was_written_from(sample, tmp_path):
    generate(sample, tmp_path, code=True)
    whole = describe(sample).description
    assert facts(imported(tmp_path, sample)) == facts(whole)


@pytest.mark.parametrize("port", PORTS)
def test_the_code_of_a_port_is_imported_as_what_it_was_written_from(port, tmp_path):
    app = described(port, tmp_path)
    generate(app, tmp_path / "code", code=True)
    description, has_threads = imported(tmp_path / "code", app), port in WITH_THREADS
    assert facts(description, has_threads) == facts(describe(app).description, has_threads)
    # By the includes; threads of C are in files of FreeRTOS.
    assert description.middleware.port == port
    assert check_colcon_meta(app, tmp_path / "code" / "colcon.meta").is_fine
    # Nothing of what import reports about programs holds for it, besides loops without sleep, and publications in them.
    findings = {each.rule for each in import_code([tmp_path / "code"]).findings}
    assert findings <= {"IMP012", "IMP013", "IMP018", "IMP020", "IMP023", "IMP026"}


def test_the_loop_that_connects_again_has_a_ping_more(tmp_path):
    app = described("freertos", tmp_path)
    text = app.read_text()
    app.write_text(re.sub(r"- \{name: second.*\}", "", text).replace("runs_in: second", "runs_in: first"))
    generate(app, tmp_path / "code", reconnect=True)
    (executor,) = [imported(tmp_path / "code", app).middleware.executor]
    items = [stated(each) for each in executor.loop.items]
    # What is done while there is no agent is no part of it; three attempts of 100 ms.
    assert items == [{"spin_some": 10**9}, {"sleep": 3 * 10**9}, {"ping": 300 * 10**9, "attempts": 3}]
    # It notices that the agent is gone.
    assert "IMP026" not in {each.rule for each in import_code([tmp_path / "code"]).findings}


@pytest.mark.parametrize(
    ("port", "options"),
    [
        *((port, {}) for port in PORTS),
        ("nuttx", {"stamps": True}),
        *((port, {"reconnect": True}) for port in ("arduino", "pico-sdk")),
    ],
)
def test_the_code_compiles(port, options, tmp_path):
    generate(described(port, tmp_path), tmp_path / "code", code=True, **options)
    (source,) = (tmp_path / "code").glob("amuros_app.*")
    text = source.read_text()
    types = set(re.findall(r"\b\w+__(?:msg|srv|action)__\w+", text))
    stubs = STUBS.read_text() + "".join(f"typedef struct {{ int content; }} {each};\n" for each in sorted(types))
    includes = "".join(f"{tmp_path}/include/{each}\n" for each in re.findall(r"#include <(.+)>", text))
    for each in includes.split():
        (path := tmp_path / each).parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    for name in ("stdbool.h", "unistd.h"):
        (tmp_path / "include" / name).unlink(missing_ok=True)
    (tmp_path / "include" / "rmw_microxrcedds_c").mkdir()
    config = "".join(
        f"#define {name} 999\n"
        for name in re.findall(r"\b(?:RMW|UXR)_\w+", (tmp_path / "code" / "amuros_limits.h").read_text())
    )
    (tmp_path / "include" / "rmw_microxrcedds_c" / "config.h").write_text(config)
    (tmp_path / "stubs.h").write_text(stubs)
    language = ["-x", "c", "-std=gnu11"] if source.suffix == ".c" else ["-x", "c++", "-std=gnu++17"]
    command = [
        "gcc",
        *language,
        "-include",
        tmp_path / "stubs.h",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-fsyntax-only",
        "-I",
        tmp_path / "include",
        source,
    ]
    run = subprocess.run(command, capture_output=True, check=False, text=True)
    assert run.stderr == ""


RECORDER = """
#include <stdio.h>
#include "amuros_stamps.h"
static long now = 0;
void amuros_send_frame(uint32_t identifier, const uint8_t * data, uint8_t length) {
  printf("(%ld.%06ld) can0 %08X#", now / 1000000, now % 1000000, identifier);
  for (int i = 0; i < length; i++) printf("%02X", data[i]);
  printf("\\n");
}
static void control(long duration) { AMUROS_STARTS(application_control); now += duration; AMUROS_ENDS(application_control); }
static void on_scan(long duration) { AMUROS_STARTS(application_on_scan); now += duration; AMUROS_ENDS(application_on_scan); }
int main(void) { for (int job = 0; job < 300; job++) { now = 20000L * job; control(100 + job % 3); on_scan(50); } }
"""


def test_the_stamps_of_the_code_are_measured(tmp_path):
    folder = tmp_path / "code"
    generate(described("nuttx", tmp_path), folder, stamps=True)
    assert "AMUROS_STARTS(application_control);" in (folder / "amuros_app.c").read_text()
    (tmp_path / "recorder.c").write_text(RECORDER)
    subprocess.run(["gcc", "-I", folder, "-o", tmp_path / "recorder", tmp_path / "recorder.c"], check=True)
    log = subprocess.run([tmp_path / "recorder"], capture_output=True, check=True, text=True).stdout
    (tmp_path / "run.log").write_text(log)
    result = measure(tmp_path / "run.log", markers=folder / "amuros.markers.yml")
    rows = {(row["object"], row["quantity"]): row for row in result.to_records()}
    # 300 jobs that take 100, 101 and 102 us in turn, and 300 of 50 us.
    keys = ("samples", "latency.min_ps", "latency.avg_ps", "latency.max_ps")
    assert [rows["control", "duration"][key] for key in keys] == [300, 100 * US, 101 * US, 102 * US]
    assert [rows["on_scan", "duration"][key] for key in keys] == [300, 50 * US, 50 * US, 50 * US]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("bounds: {string: 30}", "message_size: 64 B", "std_msgs/msg/String has no longest string or sequence"),
        ("sleep: 3 ms", "sleep: 0.5 ms", "no function of the port is known to sleep for 500 us"),
        ("priority: 4", "", "'stack' and 'priority' of 'first' are not stated"),
        (
            "parameter_server: {",
            f"lifecycle: {LIFECYCLE}\n      parameter_server: {{",
            "no code is written for a lifecycle of 'robot'",
        ),
        ("loop: {spin_some: 1 ms, sleep: 3 ms}", "period: 10 ms\n      callbacks: in-executor", "'first' has no 'loop'"),
        ("max_handles: 20", "trigger: {custom: [[control]]}", "the trigger of 'first' is a function of the application"),
    ],
)
def test_what_has_no_code_is_refused(old, new, message, tmp_path):
    app = described("freertos", tmp_path)
    app.write_text(app.read_text().replace(old, new))
    with pytest.raises(ReadError, match=re.escape(message)) as caught:
        generate(app, tmp_path / "code", code=True)
    assert {each.rule for each in caught.value.findings if each.severity == "error"} == {"GEN010"}
    assert not (tmp_path / "code").exists()


def test_what_is_stated_but_not_in_the_code_is_a_warning(tmp_path):
    app = described("freertos", tmp_path)
    app.write_text(app.read_text().replace("{name: on_mode,", "{name: on_mode, depth: 3, history: keep-all,"))
    result = generate(app, tmp_path / "code", code=True)
    found = [each.message for each in result.findings if each.rule == "GEN011"]
    assert found == [
        f"{key} is not in the code" for key in ("'depth' of 'on_mode'", "'history' of 'on_mode'", "'max_handles' of 'first'")
    ]
    assert [each for each in generate(app).findings if each.rule == "GEN011"] == []
