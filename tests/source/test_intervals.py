"""What a program does only every so often, by a clock that it reads."""

import pytest
import yaml
from importing import imported

MACRO = """#define EVERY(MS, X) do { static int64_t init = -1; if (uxr_millis() - init > MS) { X; init = uxr_millis(); } } while (0)
#define ONCE(MS, X) do { static int64_t init = -1; if (uxr_millis() - init > MS) { X; } } while (0)
"""
PROGRAM = """#include <rclc/executor.h>
{macro}
int main(void) {{
  rclc_node_init_default(&node, "robot", "", &support);
  rclc_publisher_init_best_effort(&pub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "speed");
  rclc_subscription_init_default(&sub, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "cmd");
  rclc_executor_init(&executor, &support.context, 1, &allocator);
  rclc_executor_add_subscription(&executor, &sub, &msg, &on_cmd, ON_NEW_DATA);
  while (1) {{ rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); {body} }}
}}
"""
PING = "rmw_uros_ping_agent(100, 1);"


@pytest.mark.parametrize(
    ("body", "every"),
    [
        (f"if (millis() - last > 200) {{ last = millis(); {PING} }}", "200 ms"),
        (f"if (millis() - last > 200) {{ {PING} last = millis(); }}", "200 ms"),
        # A clock that counts milliseconds shows 200 of them after more than 199.
        (f"if (millis() - last >= 200) {{ last = millis(); {PING} }}", "199 ms"),
        (f"if (connected && micros() - last > 5000) {{ last = micros(); {PING} }}", "5 ms"),
        (
            f"if (millis() - last > 200) {{ last = millis(); if (millis() - other > 500) {{ other = millis(); {PING} }} }}",
            "500 ms",
        ),
        (f"EVERY(200, ok = {PING.rstrip(';')};);", "200 ms"),
        # Nothing keeps these apart: the clock is not noted, or not always, or catches up, or is another one, or the time is not known.
        (f"if (millis() - last > 200) {{ {PING} }}", None),
        (f"if (millis() - last > 200) {{ {PING} if (ok) {{ last = millis(); }} }}", None),
        (f"if (millis() - last > 200) {{ last += 200; {PING} }}", None),
        (f"if (millis() - last > 200) {{ last = micros(); {PING} }}", None),
        (f"if (millis() - last > 200) {{ {PING} if (!ok) return 1; last = millis(); }}", None),
        (f"if (millis() - last > interval) {{ last = millis(); {PING} }}", None),
        (f"if (millis() - last > 200 || ready) {{ last = millis(); {PING} }}", None),
        (f"if (millis() - last < 200) {{ last = millis(); {PING} }}", None),
        (f"if (millis() - last > 200) {{ last = millis(); }} else {{ {PING} }}", None),
        (f"ONCE(200, ok = {PING.rstrip(';')};);", None),
    ],
)
def test_a_ping_that_a_clock_keeps_apart_says_so(body, every, tmp_path):
    loop = loop_of(PROGRAM.format(macro=MACRO, body=body), tmp_path)
    (ping,) = [item for item in loop if "ping" in item]
    assert ping.get("every") == every


def test_a_publication_that_a_clock_keeps_apart_says_so(tmp_path):
    body = "if (millis() - last > 20) { last = millis(); rcl_publish(&pub, &out, NULL); }"
    assert {"publish": ["speed"], "every": "20 ms"} in loop_of(PROGRAM.format(macro="", body=body), tmp_path)


def loop_of(text, tmp_path):
    return yaml.safe_load(imported(tmp_path, text).text)["middleware"]["executor"]["loop"]
