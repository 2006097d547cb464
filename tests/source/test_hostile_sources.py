"""Sources that nobody would write are refused, or take time in proportion to their size."""

import pytest
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
