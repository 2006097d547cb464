"""Tables fit the terminal, and nothing of them is lost."""

import re
from io import StringIO

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.report.writers.terminal import WIDTH_ELSEWHERE, Terminal

REASON = "depends on 'Sensor', which could not be analysed because of a missing execution time"


class Screen(StringIO):
    def isatty(self):
        return True


def written(headings, rows, right=(), stream_class=Screen):
    stream = stream_class()
    Terminal(stream).table(headings, rows, right)
    return stream.getvalue().splitlines()


@pytest.fixture
def columns(monkeypatch):
    return lambda number: monkeypatch.setenv("COLUMNS", str(number))


@pytest.fixture(autouse=True)
def _plain(monkeypatch):
    monkeypatch.delenv("COLUMNS", raising=False)
    monkeypatch.setenv("NO_COLOR", "1")


def test_a_table_that_fits_is_as_it_is():
    assert written(("task", "worst", ""), [("A", "1 ms", "exact"), ("Long", "12 ms", "bound")], right=(1,)) == [
        "  task  worst",
        "  A      1 ms  exact",
        "  Long  12 ms  bound",
    ]


def test_long_remarks_become_footnotes_and_equal_ones_share_theirs(columns):
    columns(80)
    rows = [("A", "?", REASON), ("B", "1 ms", "exact"), ("C", "?", REASON), ("D", "?", f"{REASON}, too")]
    assert written(("task", "worst", ""), rows, right=(1,)) == [
        "  task  worst",
        "  A         ?  [1]",
        "  B      1 ms  exact",
        "  C         ?  [1]",
        "  D         ?  [2]",
        "  [1] depends on 'Sensor', which could not be analysed because of a missing",
        "    execution time",
        "  [2] depends on 'Sensor', which could not be analysed because of a missing",
        "    execution time, too",
    ]


def test_remarks_that_fit_stay_beside_those_that_do_not(columns):
    columns(60)
    fits = "x" * (60 - len("  task") - len("  "))
    rows = [("A", fits), ("B", fits + "x")]
    assert written(("task", "reason"), rows)[1:] == [f"  A     {fits}", "  B     [1]", f"  [1] {fits}x"]


def test_footnotes_also_where_no_terminal_is_but_only_in_wide_tables(columns):
    # It is stated for terminals only: other programs may have left it.
    columns(40)
    row = ("A", "x" * 60, REASON)
    assert len(REASON) < WIDTH_ELSEWHERE < 60 + len(REASON)
    assert written(("task", "activated", ""), [row], stream_class=StringIO)[-1] == f"  [1] {REASON}"
    assert written(("task", "activated", ""), [("A", "x", REASON)], stream_class=StringIO)[-1] == f"  A     x          {REASON}"


def test_text_is_folded_on_terminals_and_nowhere_else(columns):
    headings, rows = ("task", "activated", "worst"), [("A", "3 times every 50 ms, 4 times every 500 ms", "1 ms")]
    long_name = [("A" * 200, "every 1 ms", "1 ms")]
    columns(40)
    assert any("A" * 200 in line for line in written(headings, long_name, right=(2,), stream_class=StringIO))
    assert written(headings, rows, right=(2,)) == [
        "  task  activated               worst",
        "  A     3 times every 50 ms, 4   1 ms",
        "        times every 500 ms",
    ]


@pytest.mark.parametrize("stated", ["", "0", "-1", "wide", "²"])
def test_a_width_that_is_none_is_not_taken(stated, columns):
    columns(stated)
    assert Terminal(Screen()).width is None


words = st.text("ab _", max_size=60).map(lambda text: " ".join(text.split()))


@given(st.lists(st.tuples(words, words, st.integers(0, 10**6).map(str)), max_size=8), st.integers(40, 150))
def test_a_table_with_room_for_its_numbers_is_never_wider_than_the_terminal(rows, width):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", str(width))
        patch.setenv("NO_COLOR", "1")
        lines = written(("name", "activated", "number"), rows, right=(2,))
    assert max(map(len, lines)) <= width
    # All letters of all cells are still there.
    shown, given_ = "".join(lines[1:]), "".join("".join(row) for row in rows)
    assert sorted(shown.replace(" ", "")) == sorted(given_.replace(" ", ""))


def test_what_can_be_left_out_is_before_numbers_are_cut(columns):
    columns(30)
    stream = Screen()
    Terminal(stream).table(("task", "best", "worst"), [("A_long_name", "1,234 ms", "12,345 ms")], (1, 2), (1,))
    assert stream.getvalue().splitlines() == ["  task             worst", "  A_long_name  12,345 ms", "  (no room for: best)"]


def test_a_column_that_is_left_out_is_named_as_it_is(columns):
    columns(34)
    stream = Screen()
    Terminal(stream).table(
        ("period", "the_first_of_two_long_names", "the_second_of_two_long_names"), [("1 ms", "2 ms", "3 ms")], (0, 1, 2), (2,)
    )
    lines = stream.getvalue().splitlines()
    assert max(map(len, lines)) <= 34
    assert " ".join(map(str.strip, lines[-2:])) == "(no room for: the_second_of_two_long_names)"


def test_lines_keep_numbers_with_their_units(columns):
    columns(20)
    stream = Screen()
    Terminal(stream).line("  it takes at most 12 ms here")
    assert stream.getvalue().splitlines() == ["  it takes at most", "    12 ms here"]


def test_names_that_are_longer_than_a_line_continue_between_their_parts(columns):
    columns(20)
    stream = Screen()
    Terminal(stream).line("  of Left_front_wheelSpeedOfTheVehicle now")
    assert stream.getvalue().splitlines() == ["  of", "    Left_front_wheel", "    SpeedOfThe", "    Vehicle now"]


@given(st.text("abC_/. ", max_size=200), st.integers(20, 80), st.booleans())
def test_no_line_is_wider_than_the_terminal_and_nothing_of_it_is_lost(text, width, has_style):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", str(width))
        patch.setenv("FORCE_COLOR", "1")
        patch.delenv("NO_COLOR", raising=False)
        stream = Screen()
        terminal = Terminal(stream)
        terminal.line(f"  {terminal.style(text, '1') if has_style else text} 12 ms")
    lines = re.sub(r"\x1b\[\d+m", "", stream.getvalue()).splitlines()
    assert max(map(len, lines)) <= width
    assert "".join("".join(lines).split()) == "".join(text.split()) + "12ms"


def test_several_numbers_of_a_cell_are_in_lines_of_their_own_where_it_does_not_fit(columns):
    columns(30)
    assert written(("task", "measured"), [("A_long_name", "1.5 ms / 12.5 ms / 100 ms")], right=(1,)) == [
        "  task          measured",
        "  A_long_name   1.5 ms /",
        "               12.5 ms /",
        "                  100 ms",
    ]


def test_a_stated_width_is_one_of_pipes_unless_readline_states_it(monkeypatch, columns):
    stream = StringIO()
    monkeypatch.setattr("sys.stdout", stream)
    columns(80)
    monkeypatch.delenv("LINES", raising=False)
    assert Terminal(stream).width == 80
    monkeypatch.setenv("LINES", "24")
    assert Terminal(stream).width is None


def test_a_remark_has_one_number_in_all_tables():
    stream = StringIO()
    terminal = Terminal(stream)
    for _ in range(2):
        terminal.table(("task", "reason"), [(name, REASON) for name in "ABC"])
    assert stream.getvalue().count(REASON) == 1


def test_a_line_that_fits_keeps_its_blanks_and_each_other_line_its_style(columns, monkeypatch):
    columns(20)
    monkeypatch.delenv("NO_COLOR")
    monkeypatch.setenv("FORCE_COLOR", "1")
    stream = Screen()
    terminal = Terminal(stream)
    terminal.line("  a   b      12")
    terminal.line(terminal.style("a heading of more than one line", "1"))
    bold, end = "\x1b[1m", "\x1b[0m"
    assert stream.getvalue().splitlines() == [
        "  a   b      12",
        f"{bold}a heading of more{end}",
        f"  {bold}than one line{end}",
    ]
