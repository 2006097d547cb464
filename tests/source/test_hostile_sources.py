"""Sources that nobody would write are refused, or take time in proportion to their size."""

from pathlib import Path

import pytest
from growth import growth
from importing import imported

from amalthea_uros.errors import ReadError
from amalthea_uros.services.import_code import import_code
from amalthea_uros.source import loops, program
from amalthea_uros.source.files import SourceFile
from amalthea_uros.source.syntax import parse

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


INIT = "rclc_executor_init(&executor, &support.context, 1, &allocator);\n"
SPIN = "rclc_executor_spin_some(&executor, 1000000);\n"
SPINNING = INIT + f"for (;;) {{ {SPIN} }}\n"
INT, TEXT = (f"ROSIDL_GET_MSG_TYPE_SUPPORT(std_msgs, msg, {name})" for name in ("Int32", "String"))
PUBLISH = "rcl_publish(&pub, &msg, NULL);"


def repeated(line, count):
    """A line, each time with another number in place of `@`."""
    return "\n".join(line.replace("@", str(number)) for number in range(count))


#: What is repeated: before the program, in it, and in its loop.
REPEATED = {
    "subscriptions": ("", f'rclc_subscription_init_default(&c, &node, {INT}, "c");', ""),
    "handles with texts": (
        "",
        f'rclc_subscription_init_default(&c@, &node, {TEXT}, "c@");'
        "rclc_executor_add_subscription(&executor, &c@, &msg@, &callback, ON_NEW_DATA);",
        "",
    ),
    "callbacks": (
        f"void callback@(const void * m) {{ {PUBLISH} }}",
        "rclc_executor_add_subscription(&executor, &c@, &msg, &callback@, ON_NEW_DATA);",
        "",
    ),
    "loops": ("", f"do {{ {PUBLISH} usleep(10000); }} while (true);", ""),
    "spins": ("", "", SPIN),
    "spins under locks": ("", "", f"xSemaphoreTake(mutex, 1); {SPIN} xSemaphoreGive(mutex);"),
    "locks": ("", "", "xSemaphoreTake(mutex@, 1);"),
    "executors": (
        "",
        "rclc_executor_init(&executor@, &support.context, 1, &allocator);",
        "rclc_executor_spin_some(&executor@, 1000000);",
    ),
    "publications under conditions": ("", "", f"if (a@) {{ {PUBLISH} }}"),
    "texts that are written": ("", f'snprintf(name@, 9, "a%d", @); rclc_publisher_init_default(&p@, &node, {INT}, name@);', ""),
    "functions that return a value": ("int value@() { return @; }", "usleep(value@());", ""),
    "one function that returns a value": ("", "usleep(value());", ""),
    "methods": ("class C@ { public: void s() { rcl_take(&a); } }; C@ c@;", "c@.s();", ""),
    "enumerators": ("enum { A@, B@ };", "usleep(B@);", ""),
    "conditions of the preprocessor": ("#if 0\nvoid f@() { rclc_support_fini(0); }\n#endif", "", ""),
    "macros": ("#define M@(x) if (x) { rclc_executor_spin_some(&executor, 1); }", "", "M@(1);"),
    "texts with calls": ("", 'puts("rclc_foo(1)");', ""),
}


@pytest.mark.parametrize("name", REPEATED)
def test_the_effort_for_repeated_lines_is_linear(name, tmp_path):
    before, inside, loop = REPEATED[name]

    def code(count):
        every = f"{INIT}{repeated(inside, count)}\nfor (;;) {{ {SPIN} {repeated(loop, count)} }}"
        value = f"int value() {{ {repeated('a = @;', count)} return 1; }}"
        return f"{repeated(before, count)}\n{value}\n{PROGRAM % every}"

    programs = [code(count) for count in (20, 40, 80)]
    assert growth(lambda text: imported(tmp_path, text, name="main.cpp"), programs) < 2.4


@pytest.mark.parametrize(
    ("lists", "use"),
    [
        ("int values[] = {%s};", "usleep(values[@]);"),
        ("struct S {%s}; struct S values = {%s};", "usleep(values.a@);"),
        ("enum {%s};", "usleep(E@);"),
    ],
)
def test_the_effort_for_long_lists_is_linear(lists, use, tmp_path):
    def code(count):
        parts = {"int": ",".join(count * "1"), "enum": ",".join(f"E{number}" for number in range(count))}
        members = repeated("int a@;", count), parts["int"]
        filled = lists % (members if lists.startswith("struct") else parts[lists.split()[0]])
        return f"{filled}\n{PROGRAM % (repeated(use, count) + SPINNING)}"

    programs = [code(count) for count in (20, 40, 80)]
    assert growth(lambda text: imported(tmp_path, text, name="main.cpp"), programs) < 2.4


def test_lines_are_counted_once():
    class Text(bytes):
        splits = 0

        def split(self, *arguments):
            Text.splits += 1
            return bytes.split(self, *arguments)

    file = SourceFile(Path("main.c"), Text(b"a\nbc\r\n"))
    assert [(each.line, each.column, each.text) for each in (file.location(1, 1), file.location_at(3))] == 2 * [(2, 2, "bc")]
    assert Text.splits == 1


def test_a_macro_is_parsed_once_however_often_it_is_used(tmp_path, monkeypatch):
    parsed = []
    monkeypatch.setattr(program, "parse", lambda file: parsed.append(file) or parse(file))
    imported(
        tmp_path, "#define CHECK(fn) if ((fn) != 0) { stop(); }\n" + PROGRAM % repeated("CHECK(rcl_publish(&p@, &m, 0));", 20)
    )
    assert len(parsed) == 2


def test_spins_under_many_conditions_are_refused(tmp_path, monkeypatch):
    """Each has its own loop, with everything that is in it."""
    monkeypatch.setattr(loops, "SOURCE_LOOP_ITEMS", 500)
    program = PROGRAM % f"{INIT} for (;;) {{ {repeated(f'if (a@) {{ {SPIN} }}', 25)} }}"
    with pytest.raises(ReadError, match="too much is in loops"):
        imported(tmp_path, program)


def test_a_conversion_of_great_width_is_not_followed(tmp_path):
    written = f'snprintf(name, 9, "%999999999d", 1); rclc_publisher_init_default(&p, &node, {INT}, name);'
    assert "topic: TODO" in imported(tmp_path, PROGRAM % (written + SPINNING)).text


def test_enumerators_after_a_condition_of_the_preprocessor_have_no_known_value(tmp_path):
    code = "enum { A, B,\n#ifdef X\nC,\n#endif\nD, E = 7, F };\n"
    text = imported(tmp_path, code + PROGRAM % (repeated("", 1) + INIT + f"for (;;) {{ {SPIN} usleep(B * 1000); }}")).text
    assert "sleep: 1 ms" in text
    for name, time in (("C", "TODO"), ("D", "TODO"), ("E", "7 ms"), ("F", "8 ms")):
        loop = f"{INIT} for (;;) {{ {SPIN} usleep({name} * 1000); }}"
        assert f"sleep: {time}" in imported(tmp_path, code + PROGRAM % loop).text


#: Files whose texts have no end, or much of the same: most took the square of their size, or all memory.
ENDLESS = {
    "main.c": (
        "{begin}" + "/*" * 200_000,
        "{begin}" + '\\"' * 200_000,
        "{begin}" + "\n" * 400_000,
        "{begin}" + "#include <\n" * 40_000,
        "{begin}int f() {{" + "static " * 60_000 + "; return x; }}",
        "{begin}" + "K_THREAD_STACK_DEFINE(a," * 20_000,
        "{begin}" + "memory" * 60_000,
    ),
    "app.meta": ("/*" * 200_000, '\\"' * 200_000, "".join(f'"-DA{number}=1"\n' for number in range(20_000))),
    "prj.conf": ("A = a" + " " * 400_000 + "x", "A =\n" + " a\n" * 100_000),
    "platformio.ini": (
        "".join(f"[env:e{number}]\nextends = {' '.join(f'env:e{each}' for each in range(10))}\n" for number in range(10)),
        "[a]\nb = " + "x" * 200_000 + "\n[env:e]\nboard = " + "${{a.b}}" * 20_000,
    ),
    "CMakeLists.txt": ("\n" * 400_000, "pico_enable_stdio_usb(app 1)\n" * 15_000),
    "my/msg/A.idl": tuple(
        "module my {{ module msg {{ " + text
        for text in (
            "\n" * 400_000,
            "typedef a" * 40_000,
            "struct a {{" * 40_000,
            "struct a {{ b" + " " * 400_000 + "!; }}",
            '\\"' * 200_000,
        )
    ),
}


@pytest.mark.parametrize(
    ("name", "text"), [(name, text) for name, texts in ENDLESS.items() for text in texts], ids=lambda each: each[:30]
)
def test_texts_without_an_end_are_read(name, text, tmp_path):
    path = tmp_path / name
    path.parent.mkdir(parents=True, exist_ok=True)
    program = PROGRAM % SPINNING
    (tmp_path / "main.c").write_text(program)
    path.write_text(text.format(begin=program))
    assert "executor:" in import_code(tmp_path).text


def test_a_class_that_seems_to_contain_itself_is_read(tmp_path):
    """As where a brace is missing; members of members were counted along all ways, 12^20 of them."""
    members = "".join(f"Motor part{number};" for number in range(12))
    setup = "void setup(rcl_node_t & node) { rclc_publisher_init_default(&pub_, &node, type, topic_); }"
    code = (
        f"class Motor {{ public: {members} {setup} rcl_publisher_t pub_; }};\nMotor motor;\n" + PROGRAM % "motor.setup(node);"
    )
    assert "publishers:" in imported(tmp_path, code, name="main.cpp").text
