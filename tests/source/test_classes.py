"""Several objects of one class, each with entities of its own."""

import pytest
from importing import described, imported, rules

TYPE = "ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32)"
CLASS = f"""
class Wheel {{
 public:
  void begin(const char * topic) {{ check(rclc_publisher_init_best_effort(&pub, &node, {TYPE}, topic)); }}
  void send() {{ check(rcl_publish(&pub, &msg, NULL)); }}
 private:
  rcl_publisher_t pub;
}};
"""
MAIN = """
void on_timer(rcl_timer_t * t, int64_t last) {{ {send} }}
void setup() {{
  check(rclc_node_init_default(&node, "n", "", &support));
  {begin}
  check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS(50), on_timer));
  check(rclc_executor_init(&executor, &support.context, 1, &allocator));
  check(rclc_executor_add_timer(&executor, &timer));
}}
void loop() {{ rclc_executor_spin_some(&executor, RCL_MS_TO_NS(10)); }}
"""


@pytest.mark.parametrize(
    ("objects", "begin", "send", "topics", "published"),
    [
        ("Wheel left, right;", 'left.begin("l"); right.begin("r");', "right.send();", ["l", "r"], "publishes: [r]"),
        ("Wheel w[2];", 'for (int i = 0; i < 2; i++) w[i].begin(names[i]);', "w[1].send();", ["l", "r"], "publishes: [r]"),
        ("Wheel only;", 'only.begin("l");', "only.send();", ["l"], "publishes: [l]"),
        # Which of them publishes is unknown.
        ("Wheel w[2];", 'w[0].begin("l"); w[1].begin("r");', "w[next()].send();", ["l", "r"], "publishes: TODO"),
    ],
)  # fmt: skip
def test_each_object_has_its_own_entities(objects, begin, send, topics, published, tmp_path):
    names = 'const char * const names[] = {"l", "r"};\n'
    result = imported(tmp_path, names + CLASS + objects + MAIN.format(begin=begin, send=send), "main.ino")
    assert [f"topic: {topic} #" for topic in topics if f"topic: {topic} #" not in result.text] == []
    assert result.text.count("topic:") == len(topics)
    assert published in result.text
    assert [each for each in described(result, tmp_path)[1] if each.severity == "error"] == []


def test_what_a_constructor_creates_for_each_object_is_a_finding(tmp_path):
    text = CLASS.replace("void begin(const char * topic)", "Wheel(const char * topic)") + 'Wheel left("l"), right("r");'
    assert "IMP003" in rules(imported(tmp_path, text + MAIN.format(begin="", send="left.send();"), "main.ino"))


@pytest.mark.parametrize(
    ("members", "period"),
    [
        ("static constexpr int period = 20;", "period: 20 ms"),
        ("int period = 20;", "period: 20 ms"),
        ("int period; Robot() : period(20) {}", "period: 20 ms"),
        ("int period; Robot() { period = 20; }", "period: 20 ms"),
        # The constructor counts, not the default.
        ("int period = 10; Robot(int given) : period(given) {}", "period: 20 ms"),
        # Another function may change it before.
        ("int period = 20; void set(int value) { period = value; }", "period: TODO"),
        ("int period; Robot(int given) : period(given) {} Robot() : period(5) {}", "period: TODO"),
    ],
)
def test_a_member_has_what_it_is_initialised_with(members, period, tmp_path):
    timer = "check(rclc_timer_init_default(&timer, &support, RCL_MS_TO_NS({}), on_timer));"
    robot = f"class Robot {{ public: {members} void begin() {{ {timer.format('period')} }} }};"
    given = "Robot robot(20);" if "given" in members else "Robot robot;"
    program = MAIN.replace(timer.format(50), "robot.begin();")
    result = imported(tmp_path, robot + given + program.format(begin="", send=""), "main.ino")
    assert period in result.text
