"""What is said on a terminal while something takes long."""

import re
import sys
from contextlib import nullcontext, redirect_stderr, redirect_stdout
from io import StringIO
from threading import Event

import pytest
from click import Context
from click.testing import CliRunner
from support import ROOT

from amalthea_uros.cli import patience
from amalthea_uros.cli.main import COMMANDS, cli

SAMPLE = str(ROOT / "samples" / "bodas-test-advanced.yaml")
#: These commands show what is at hand, or wait for a client.
SHORT = {"init", "explain", "schema", "completion", "lsp"}


class Terminal(StringIO):
    def __init__(self):
        super().__init__()
        self.is_written = Event()

    def isatty(self):
        return True

    def write(self, text):
        self.is_written.set()
        return super().write(text)


@pytest.fixture
def terminal(monkeypatch):
    """A terminal whose user has no patience."""
    monkeypatch.setattr(patience, "PATIENCE", 0)
    return Terminal()


def run(terminal, name, work):
    """A command with some work, both of whose standard streams are a terminal."""
    with redirect_stdout(terminal), redirect_stderr(terminal):
        patience.with_progress(name, work)()


def seen(terminal):
    """What is left on the screen of a terminal, and the lines that were there in between."""
    left, between = [""], []
    for text in re.split(r"(\r|\n)", terminal.getvalue()):
        if text == "\r":
            between.append(left[-1].rstrip())
            left[-1] = ""
        elif text == "\n":
            left.append("")
        else:
            left[-1] = text + left[-1][len(text) :]
    return "\n".join(map(str.rstrip, left)), [line for line in between if line]


@pytest.mark.parametrize(("is_fast", "hint"), [(True, ""), (False, "; faster: pip install 'amuros[fast]'")])
def test_what_takes_long_is_reported_and_removed_again(monkeypatch, terminal, is_fast, hint):
    monkeypatch.setattr(patience, "is_available", lambda: is_fast)
    run(terminal, "simulate", lambda: terminal.is_written.wait(10))
    line = f"Simulating: 0 s so far{hint}"
    assert terminal.getvalue() == f"\r{line}\r{' ' * len(line)}\r"


def test_what_a_command_shows_takes_the_place_of_the_line(terminal):
    def work():
        terminal.is_written.wait(10)
        sys.stdout.write("a result\n")
        sys.stderr.write("a finding\n")

    run(terminal, "check", work)
    assert seen(terminal) == ("a result\na finding\n", ["Checking: 0 s so far"])


def test_the_line_does_not_interrupt_a_line_of_the_result(terminal):
    def work():
        sys.stdout.write("a part of")
        for _ in range(1000):
            sys.stdout._line._show()
        sys.stdout.write(" a line\n")

    run(terminal, "check", work)
    assert seen(terminal)[0] == "a part of a line\n"


def test_the_streams_are_as_before(terminal):
    with redirect_stdout(terminal), redirect_stderr(terminal):
        with pytest.raises(SystemExit):
            patience.with_progress("check", lambda: sys.exit(1))()
        assert sys.stdout is sys.stderr is terminal


def test_parts_of_a_command_have_names(terminal):
    def work():
        terminal.is_written.wait(10)
        with patience.working("Trying changes", 3) as progress:
            progress.step()
            sys.stdout._line._show()
        sys.stdout._line._show()

    run(terminal, "analyze", work)
    lines = [line.partition(":")[0] for line in seen(terminal)[1]]
    assert lines == ["Analyzing", "Trying changes (1/3)", "Analyzing"]


def test_steps_are_counted_within_the_width_of_a_terminal():
    progress = patience.Progress("Judging designs", 10_000)
    progress.reach(1199)
    progress.step()
    assert str(progress) == "Judging designs (1200/10000)"
    assert len(f"{progress}: 120 s so far{patience.FASTER}") < 80


def test_the_line_is_cut_where_the_terminal_ends(monkeypatch, terminal):
    monkeypatch.setenv("COLUMNS", "12")
    run(terminal, "check", lambda: terminal.is_written.wait(10))
    assert seen(terminal) == ("", ["Checking: 0"])


def test_reading_is_not_said_to_become_faster(monkeypatch, terminal):
    monkeypatch.setattr(patience, "is_available", lambda: False)
    run(terminal, "measure", lambda: terminal.is_written.wait(10))
    assert seen(terminal)[1] == ["Measuring: 0 s so far"]


@pytest.mark.parametrize("name", sorted(set(COMMANDS) - SHORT))
def test_every_command_says_what_it_does(monkeypatch, name):
    """However it ends: here by a wrong use, of which some commands only know once they have begun."""
    monkeypatch.setattr(sys, "stderr", Terminal())
    command, began = cli.get_command(Context(cli), name), []
    monkeypatch.setattr(patience._ProgressLine, "shown", lambda line: began.append(str(patience._present[-1])) or nullcontext())
    with pytest.raises((TypeError, KeyError)):
        command.callback(**({"watch": False} if any(each.name == "watch" for each in command.params) else {}))
    assert began == [patience.WORK[name]]


#: A command -> the words of a part of it.
PARTS = {
    ("analyze", SAMPLE): "Trying changes",
    ("sweep", SAMPLE, "--sweep", "Executor_Task.period=1ms,2ms"): "Analyzing (0/2)",
    ("optimize", SAMPLE, "--designs", "2"): "Judging designs (0/2)",
    ("simulate", SAMPLE, "--duration", "1ms"): "Simulating 1 ms",
    ("simulate", SAMPLE, "--duration", "1ms", "--runs", "2", "--jobs", "1"): "Simulating (0/2)",
    ("migrate", str(ROOT / "samples" / "pump-1.2.0.amxmi"), "--dry-run"): "Migrating (0/1)",
}


@pytest.mark.parametrize("arguments", PARTS, ids=" ".join)
def test_commands_name_their_parts(monkeypatch, arguments):
    class Kept(list):
        def append(self, progress):
            labels.append(str(progress))
            super().append(progress)

    labels = []
    monkeypatch.setattr(patience, "_present", Kept())
    CliRunner().invoke(cli, arguments)
    assert labels == [patience.WORK[arguments[0]], *labels[1:]]
    assert PARTS[arguments] in labels


def test_what_is_fast_is_not_reported():
    run(terminal := Terminal(), "analyze", lambda: None)
    assert terminal.getvalue() == ""


def test_files_get_nothing(monkeypatch):
    monkeypatch.setattr(patience, "PATIENCE", 0)
    run(file := StringIO(), "analyze", lambda: sys.stderr.write("a finding\n"))
    assert file.getvalue() == "a finding\n"
