"""What is said on a terminal while something takes long."""

import sys
from io import StringIO
from threading import Event

import pytest

from amalthea_uros.cli import patience


class Terminal(StringIO):
    def __init__(self):
        super().__init__()
        self.is_written = Event()

    def isatty(self):
        return True

    def write(self, text):
        self.is_written.set()
        return super().write(text)


@pytest.mark.parametrize(("is_fast", "hint"), [(True, ""), (False, "; pip install 'amuros[fast]' makes this faster")])
def test_what_takes_long_is_reported_and_removed_again(monkeypatch, is_fast, hint):
    monkeypatch.setattr(patience, "PATIENCE", 0)
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    monkeypatch.setattr(patience, "is_available", lambda: is_fast)
    with patience.working("Simulating 10 min"):
        assert terminal.is_written.wait(10)
    line = f"Simulating 10 min: 0 s so far{hint}"
    assert terminal.getvalue() == f"\r{line}\r{' ' * len(line)}\r"
    assert len(line) < 80


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
