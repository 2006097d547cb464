"""Loops as people write them: what is in them, in which order, and what a call that seems to sleep does."""

import pytest
from importing import described, imported, rules

HEAD = """
void main(void) {
  check(rclc_node_init_default(&node, "n", "", &support));
  check(rclc_publisher_init_best_effort(&p, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "out"));
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(50), on_timer));
  check(rclc_executor_init(&e, &support.context, 1, &allocator));
  check(rclc_executor_add_timer(&e, &timer));
"""
SPIN = "rclc_executor_spin_some(&e, RCL_MS_TO_NS(10));"


def loop_of(text):
    """The lines of the loop of a description, without comments."""
    lines = [line.partition(" #")[0] for line in text.splitlines()]
    first = next(number for number, line in enumerate(lines) if line.strip().startswith("loop:"))
    indent = len(lines[first]) - len(lines[first].lstrip())
    items = []
    for line in lines[first + 1 :]:
        if len(line) - len(line.lstrip()) <= indent:
            break
        items.append(line.strip().removeprefix("- "))
    return items or [lines[first].strip().removeprefix("loop: ")]


def loop(tmp_path, body, includes="", **others):
    return loop_of(imported(tmp_path, f"{includes}{HEAD} while (1) {{ {body} }} }}", **others).text)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (f"{SPIN} HAL_Delay(5);", ["spin_some: 10 ms", "busy_wait: 5 ms"]),
        (f"rcl_publish(&p, &m, NULL); {SPIN}", ["publish: [out]", "spin_some: 10 ms"]),
        # Twice 100 ms at most.
        (
            f"{SPIN} rmw_uros_ping_agent(100, 2); usleep(1000);",
            ["spin_some: 10 ms", "{ping: 200 ms, attempts: 2}", "sleep: 1 ms"],
        ),
        (f"rmw_uros_sync_session(1000); {SPIN}", ["sync: 1 s", "spin_some: 10 ms"]),
        (f"{SPIN} HAL_Delay(wait());", ["spin_some: 10 ms", "busy_wait: TODO"]),
        # Sleeps of other states, and of another branch, are no part of the rounds that spin.
        (f"if (connected) {{ {SPIN} }} else {{ delay(500); }}", ["{spin_some: 10 ms}"]),
        (
            f"switch (s) {{ case 1: delay(500); break; case 2: {SPIN} usleep(3000); break; }}",
            ["{spin_some: 10 ms, sleep: 3 ms}"],
        ),
        (f"{SPIN} if (idle) {{ usleep(500); }}", ["{spin_some: 10 ms, sleep: TODO}"]),
        # A loop in it is a part of each iteration, however often; one that counts to a constant is known.
        (
            f"{SPIN} while (busy) {{ rcl_publish(&p, &m, NULL); usleep(9); }}",
            ["spin_some: 10 ms", "publish: [out]", "sleep: TODO"],
        ),
        (f"{SPIN} for (int i = 0; i < 3; i++) {{ usleep(1000); }}", ["{spin_some: 10 ms, sleep: 3 ms}"]),
        # The description has no loop in which an executor spins twice.
        (f"{SPIN} usleep(1000); {SPIN}", ["TODO"]),
        # Arduino without an operating system waits busily.
        (f"{SPIN} delay(5);", ["spin_some: 10 ms", "busy_wait: 5 ms"]),
    ],
)
def test_a_loop_has_its_items_in_order(body, expected, tmp_path):
    assert loop(tmp_path, body) == expected


ESP32 = '#include "freertos/FreeRTOS.h"\n'


@pytest.mark.parametrize(
    ("includes", "call", "ticks", "expected"),
    [
        # 1 ms is no tick at 100 Hz, and one at 1000 Hz; a project that says nothing has 100 Hz, or was configured elsewhere.
        (ESP32, "vTaskDelay(pdMS_TO_TICKS(1));", 100, ["{spin_some: 10 ms}"]),
        (ESP32, "vTaskDelay(pdMS_TO_TICKS(1));", 1000, ["{spin_some: 10 ms, sleep: 1 ms}"]),
        (ESP32, "vTaskDelay(pdMS_TO_TICKS(1));", None, ["{spin_some: 10 ms, sleep: TODO}"]),
        (ESP32, "vTaskDelay(2);", 100, ["{spin_some: 10 ms, sleep: 20 ms}"]),
        (ESP32, "vTaskDelay(2);", None, ["{spin_some: 10 ms, sleep: TODO}"]),
        # Below a tick, usleep of ESP-IDF does not let others execute.
        (ESP32, "usleep(5000);", 100, ["spin_some: 10 ms", "busy_wait: 5 ms"]),
        (ESP32, "usleep(5000);", 1000, ["{spin_some: 10 ms, sleep: 5 ms}"]),
        ("#include <zephyr/kernel.h>\n", "usleep(1000000);", None, ["{spin_some: 10 ms}"]),
        ("#include <zephyr/kernel.h>\n", "usleep(999999);", None, ["{spin_some: 10 ms, sleep: 999.999 ms}"]),
        ("", "usleep(1000000);", None, ["{spin_some: 10 ms, sleep: 1 s}"]),
    ],
)
def test_a_sleep_is_what_the_port_makes_of_it(includes, call, ticks, expected, tmp_path):
    others = {} if ticks is None else {"sdkconfig": f"CONFIG_FREERTOS_HZ={ticks}\n"}
    assert loop(tmp_path, f"{SPIN} {call}", includes, **others) == expected


def test_a_thread_that_only_publishes_is_in_the_description(tmp_path):
    threads = "void send(void *a) { while (1) { rcl_publish(&p, &m, NULL); vTaskDelay(pdMS_TO_TICKS(20)); } }\n"
    body = f'xTaskCreate(send, "sender", 1000, NULL, 7, NULL); while (1) {{ {SPIN} usleep(1000); }} }}'
    result = imported(tmp_path, threads + HEAD + body)
    assert "- name: sender" in result.text
    assert loop_of(result.text.partition("name: sender")[2]) == ["publish: [out]", "sleep: 20 ms"]
    description, findings = described(result, tmp_path)
    assert description.middleware.executors[1].loop.only_sends
    # The threads are two, and nothing locks their session.
    assert "EXE008" in {finding.rule for finding in findings}


def test_what_is_not_understood_of_an_executor_is_a_gap(tmp_path):
    text = 'void main(void) { check(rclc_node_init_default(&node, "n", "", &s)); check(rclc_executor_init(&e, &c, 1, &a));'
    result = imported(tmp_path, f"{text} while (1) {{ {SPIN} usleep(1000); }} }}")
    assert "order: TODO" in result.text
    # Without any callback, which then is stated, it is accepted.
    assert [each for each in described(result, tmp_path)[1] if each.severity == "error"] == []


@pytest.mark.parametrize(
    ("definition", "size"),
    [
        ("float32[4] speed\nbool moving", "17 B"),
        # 1, 3 to align, 4: a constant and a comment take nothing.
        ("uint8 KIND=3\nbool on # or off\nint32 count 5", "8 B"),
        ("geometry_msgs/Vector3[2] ends", "48 B"),
        # Without an end: the length of an empty one is no length.
        ("string name", "TODO"),
        ("Wheels inner", "TODO"),
    ],
)
def test_messages_of_the_application_have_a_size(definition, size, tmp_path):
    (tmp_path / "my_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "my_msgs" / "msg" / "Wheels.msg").write_text(definition)
    result = imported(tmp_path, HEAD.replace("std_msgs, msg, Int32", "my_msgs, msg, Wheels") + f"while (1) {{ {SPIN} }} }}")
    assert f"message_size: {size}" in result.text


def test_build_options_have_units(tmp_path):
    options = {"UCLIENT_CUSTOM_TRANSPORT_MTU": "1024", "RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT": "500", "RMW_UXRCE_GRAPH": "OFF"}
    arguments = ", ".join(f'"-D{name}={value}"' for name, value in options.items())
    result = imported(tmp_path, f"{HEAD} while (1) {{ {SPIN} }} }}", colcon__meta=f'{{"cmake-args": [{arguments}]}}')
    limits = described(result, tmp_path)[0].middleware.limits
    assert (limits.UCLIENT_CUSTOM_TRANSPORT_MTU, limits.RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT) == (8 * 1024, 500 * 10**9)
    assert limits.RMW_UXRCE_GRAPH is False


@pytest.mark.parametrize(
    ("memory", "expected"),
    [
        ("", {"IMP021"}),
        ("text.data.data = buffer; text.data.capacity = 20;", set()),
        ("micro_ros_utilities_create_message_memory(support_of(t), &text, options);", set()),
    ],
)
def test_a_string_that_is_received_needs_memory(memory, expected, tmp_path):
    added = """check(rclc_subscription_init_default(&s, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, String), "t"));
      check(rclc_executor_add_subscription(&e, &s, &text, &on_text, ON_NEW_DATA));"""
    source = HEAD.replace(", 1, &allocator", ", 2, &allocator") + f"{memory} {added} while (1) {{ {SPIN} usleep(1000); }} }}"
    assert rules(imported(tmp_path, source)) & {"IMP021"} == expected
