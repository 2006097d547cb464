"""What is said on a terminal while something takes long."""

import sys
from contextlib import contextmanager
from io import StringIO
from threading import Event

import pytest
from click import Context
from click.testing import CliRunner
from support import ROOT

from amalthea_uros.cli import patience
from amalthea_uros.cli.main import cli

SAMPLE = str(ROOT / "samples" / "bodas-test-advanced.yaml")


class Terminal(StringIO):
    def __init__(self):
        super().__init__()
        self.is_written = Event()

    def isatty(self):
        return True

    def write(self, text):
        self.is_written.set()
        return super().write(text)


@pytest.mark.parametrize(("is_fast", "hint"), [(True, ""), (False, "; faster: pip install 'amuros[fast]'")])
def test_what_takes_long_is_reported_and_removed_again(monkeypatch, is_fast, hint):
    monkeypatch.setattr(patience, "PATIENCE", 0)
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    monkeypatch.setattr(patience, "is_available", lambda: is_fast)
    with patience.working("Simulating 10 min"):
        assert terminal.is_written.wait(10)
    line = f"Simulating 10 min: 0 s so far{hint}"
    assert terminal.getvalue() == f"\r{line}\r{' ' * len(line)}\r"
    assert len(line) < 80


def test_steps_are_counted_within_the_width_of_a_terminal():
    progress = patience.Progress("Judging designs", 10_000)
    progress.reach(1199)
    progress.step()
    assert str(progress) == "Judging designs (1200/10000)"
    assert len(f"{progress}: 120 s so far{patience.FASTER}") <= 80


def test_reading_is_not_said_to_become_faster(monkeypatch):
    monkeypatch.setattr(patience, "PATIENCE", 0)
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    monkeypatch.setattr(patience, "is_available", lambda: False)
    with patience.working("Reading", is_computing=False):
        assert terminal.is_written.wait(10)
    assert terminal.getvalue().startswith("\rReading: 0 s so far\r")


#: A command -> the words of its line. All that can take long say so.
COMMANDS = {
    ("analyze", SAMPLE): "Analyzing",
    ("sweep", SAMPLE, "--sweep", "Executor_Task.period=1ms,2ms"): "Analyzing (",
    ("optimize", SAMPLE, "--designs", "2"): "Judging designs (",
    ("simulate", SAMPLE, "--duration", "1ms"): "Simulating 1 ms",
    ("simulate", SAMPLE, "--duration", "1ms", "--runs", "2", "--jobs", "1"): "Simulating (",
    ("check", SAMPLE): "Checking",
    ("build", SAMPLE, "-o", "-"): "Building",
    ("diff", SAMPLE, SAMPLE): "Comparing",
    ("migrate", str(ROOT / "samples" / "pump-1.2.0.amxmi"), "--dry-run"): "Migrating (",
}


@pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
def test_commands_say_that_they_are_in_progress(monkeypatch, arguments):
    labels = []

    @contextmanager
    def working(label, total=0, *, is_computing=True):
        labels.append(f"{label} (" if total else label)
        yield patience.Progress(label, total)

    cli.get_command(Context(cli), arguments[0])
    for module in [
        each for name, each in sys.modules.items() if name.startswith("amalthea_uros.cli.") and hasattr(each, "working")
    ]:
        monkeypatch.setattr(module, "working", working)
    CliRunner().invoke(cli, arguments)
    assert COMMANDS[arguments] in labels


def test_what_is_fast_is_not_reported(monkeypatch):
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    with patience.working("Analyzing"):
        pass
    assert terminal.getvalue() == ""


def test_files_get_nothing(monkeypatch):
    monkeypatch.setattr(patience, "PATIENCE", 0)
    monkeypatch.setattr(sys, "stderr", file := StringIO())
    with patience.working("Analyzing"):
        pass
    assert file.getvalue() == ""
