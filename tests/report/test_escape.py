"""Nothing that a name contains acts on a terminal, or on the log of a CI system."""

import json
import unicodedata
from io import StringIO
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.findings.presentation import present
from amalthea_uros.report import formats
from amalthea_uros.report.basics.escape import output_line, visible
from amalthea_uros.report.pictures.svg import element, text
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.check import CheckResult

#: Any character that a file or the name of a file can have, with those that act in some way more often.
NAMES = st.text(
    st.one_of(st.characters(exclude_categories=["Cs"]), st.sampled_from("\n\r\t\x1b\x7f\x85\u202e\u2066\u2028\ufeff\udcff:#")),
    max_size=20,
)


def result(name):
    location = Location(Path(name.replace("\0", "") or "x"), 1, 1 + len(name), name + "x")
    finding = Finding("XMI020", Severity.ERROR, f"{name} is wrong", location, name, name)
    return CheckResult(
        paths=(location.path,),
        findings=(finding,),
        presentation=present([finding], set()),
        fail_on=Severity.ERROR,
        is_readable=True,
        rules=(),
    )


def written(format_name, name):
    stream = StringIO()
    formats.write(format_name, result(name), stream)
    return stream.getvalue()


@pytest.mark.parametrize("format_name", ["text", "json", "sarif", "junit", "github"])
@given(name=NAMES)
@example("a\n::error::b")
@example("::error::b")
@example("\x1b[31m\u202e\u2028")
def test_no_line_has_control_characters(format_name, name):
    lines = written(format_name, name).split("\n")
    # Cc: C0, DEL and C1; Zl and Zp: line separators; Cs: surrogates; and the marks of direction.
    assert not [
        c for line in lines for c in line if unicodedata.category(c) in ("Cc", "Zl", "Zp", "Cs") or c in "\u202e\u2066\ufeff"
    ]
    if format_name != "github":
        assert not [line for line in lines if line.lstrip().startswith("::")]
    else:
        assert len(lines) == 2


@given(name=NAMES)
def test_json_keeps_the_name(name):
    assert json.loads(written("json", name))["findings"][0]["object"] == name


@given(name=NAMES)
def test_junit_and_svg_are_well_formed(name):
    ElementTree.fromstring(written("junit", name))
    ElementTree.fromstring(element("text", text(name), class_=name))


@given(st.text(st.characters(categories=["L", "N", "P", "S"]), max_size=30))
def test_visible_text_is_shown_as_it_is(name):
    assert visible(name) == name


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("a\nb", r"a\nb"),
        ("\x1b[2J", r"\x1b[2J"),
        ("\u202e", r"\u202e"),
        ("\udcff", r"\xff"),
        ("\U000e0041", r"\U000e0041"),
        ("::error::x", r"\x3a:error::x"),
        ("  ::error::x", r"  \x3a:error::x"),
        ("a ##[error]x", r"a \x23#[error]x"),
        ("a##vso[task.x]", r"a\x23#vso[task.x]"),
        ("a::b # c", "a::b # c"),
    ],
)
def test_lines_of_output(name, shown):
    assert output_line(name) == shown


class Screen(StringIO):
    """A stream that is a terminal."""

    def isatty(self):
        return True


def test_styles_are_ours_and_not_those_of_names(monkeypatch):
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    screen = Screen()
    terminal = Terminal(screen)
    terminal.line(f"{terminal.style('a', '1')} \x1b[2J")
    assert screen.getvalue() == "\x1b[1ma\x1b[0m \\x1b[2J\n"


def test_the_caret_is_below_its_character():
    stream = StringIO()
    Terminal(stream).snippet(Location(Path("x"), 1, 3, "a\x1bb"))
    line, caret, _ = stream.getvalue().split("\n")
    assert line[caret.index("^")] == "b"
