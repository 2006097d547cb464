"""Sources that nobody would write are refused, or take time in proportion to their size."""

import pytest
from growth import growth
from importing import imported

PROGRAM = 'void microros_entry(void * p) {\n  rclc_node_init_default(&node, "a", "", &support);\n%s\n}\n'


@pytest.mark.parametrize(("opening", "closing"), [("struct {", "} x;"), ("f(", ")"), ("a = (", ")"), ("if (x) {", "}")])
def test_what_is_nested_too_deeply_is_not_read(opening, closing, tmp_path):
    def messages(depth):
        result = imported(tmp_path, PROGRAM % (opening * depth + "1;" + closing * depth))
        return {finding.message for finding in result.findings if finding.rule == "IMP002"}

    assert messages(60) == set()
    assert messages(5000) == {"the code is nested too deeply; the file is not read"}


def test_a_template_in_a_structure_is_none_of_the_structure(tmp_path):
    from amalthea_uros.source.files import read_sources
    from amalthea_uros.source.program import read_program

    (tmp_path / "main.cpp").write_text("struct { std::array<int, 4> inner; } outer;")
    assert dict(read_program(read_sources([tmp_path]).code).arrays) == {"inner": {"4"}}


#: What is repeated -> how many times the steps may grow when a doubled number of it is doubled again: 2 is linear, 4 quadratic.
REPEATED = {
    'rclc_subscription_init_default(&c, &node, ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, Int32), "c");': 2.3,
    "do { rcl_publish(&pub, &msg, NULL); usleep(10000); } while (true);": 4.3,
}


def test_an_executor_that_spins_often_in_a_loop_is_read_in_time_for_its_size(tmp_path):
    created = "rclc_executor_init(&executor, &support.context, 1, &allocator);\n"
    spin = "rclc_executor_spin_some(&executor, 1000000);\n"
    programs = [PROGRAM % f"{created}for (;;) {{ {count * spin} }}" for count in (20, 40, 80)]
    assert growth(lambda program: imported(tmp_path, program), programs) < 2.8


@pytest.mark.parametrize("line", REPEATED)
def test_the_effort_for_repeated_lines_stays_small(line, tmp_path):
    created = "rclc_executor_init(&executor, &support.context, 1, &allocator);\n"
    spinning = created + "for (;;) { rclc_executor_spin_some(&executor, 1000000); }"
    programs = [PROGRAM % (count * f"{line}\n" + spinning) for count in (10, 20, 40)]
    assert growth(lambda program: imported(tmp_path, program), programs) < REPEATED[line]


def test_a_class_that_seems_to_contain_itself_is_read(tmp_path):
    """As where a brace is missing; members of members were counted along all ways, 12^20 of them."""
    members = "".join(f"Motor part{number};" for number in range(12))
    setup = "void setup(rcl_node_t & node) { rclc_publisher_init_default(&pub_, &node, type, topic_); }"
    code = (
        f"class Motor {{ public: {members} {setup} rcl_publisher_t pub_; }};\nMotor motor;\n" + PROGRAM % "motor.setup(node);"
    )
    assert "publishers:" in imported(tmp_path, code, name="main.cpp").text
