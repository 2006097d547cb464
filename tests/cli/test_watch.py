"""`--watch`: a real process, real files."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest
from command import amuros
from support import ROOT

from amalthea_uros.cli.watch import watched_files

YAML = ROOT / "samples" / "bodas-test-simple.yaml"


class Watching:
    """A command with `--watch`, and the lines that it writes."""

    def __init__(self, folder, *arguments):
        command = [sys.executable, "-m", "amalthea_uros", *map(str, arguments), "--watch"]
        environment = os.environ | {"PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"}
        self.process = subprocess.Popen(
            command, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        self.lines = []
        self.reader = threading.Thread(target=lambda: self.lines.extend(iter(self.process.stdout.readline, "")), daemon=True)
        self.reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.reader.join(5)
        self.process.stdout.close()

    def wait_for(self, text, number=1):
        """The lines, as soon as so many of them have a text."""
        end = time.monotonic() + 60
        while sum(text in line for line in self.lines) < number:
            assert time.monotonic() < end, self.lines
            assert self.process.poll() is None, self.lines
            time.sleep(0.02)
        return list(self.lines)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "app.yaml").write_text(YAML.read_text())
    return tmp_path


def test_a_change_starts_another_run_and_ctrl_c_ends_it(folder):
    with Watching(folder, "analyze", "app.yaml", "-q") as run:
        run.wait_for("watching 1 file for changes; Ctrl-C ends it")
        assert run.lines[0].startswith("Schedulable: yes")
        (folder / "app.yaml").write_text(YAML.read_text().replace("response_time: 1 ms", "response_time: 10 us"))
        lines = run.wait_for("watching", 2)
        assert lines[2] == "app.yaml changed; running again\n"
        assert lines[3].startswith("Schedulable: no")
        run.process.send_signal(signal.SIGINT)
        assert run.process.wait(20) == 130


def test_an_error_and_a_missing_file_do_not_end_it(folder):
    path = folder / "app.yaml"
    with Watching(folder, "check", "app.yaml", "-q") as run:
        run.wait_for("watching")
        path.write_text("amuros: [")
        run.wait_for("YML", 1)
        run.wait_for("watching", 2)
        path.unlink()
        run.wait_for("watching", 3)
        path.write_text(YAML.read_text())
        assert run.wait_for("watching", 4)[-2] == "no findings\n"


def test_what_is_watched(folder):
    path = folder / "app.yaml"
    (folder / "a.amxmi").touch()
    assert watched_files([folder]) == {folder / "a.amxmi"}
    for text in ("hardware:\n  platform: ./mine.yaml # ours\n", "hardware: {platform: 'mine.yml', cores: 2}\n"):
        path.write_text(text)
        assert watched_files([path]) == {path, folder / ("mine.yml" if "yml" in text else "mine.yaml")}
    path.write_text("controllers:\n  - {name: a, file: a.yaml}\n  - {name: b, file: 'sub/b.yml'}\n")
    (folder / "a.yaml").write_text("hardware: ./board.yaml\nmiddleware: {transport: {can: {dbc: bus.dbc}}}\n")
    named = ("a.yaml", "sub/b.yml", "board.yaml", "bus.dbc")
    assert watched_files([path]) == {path, *(folder / name for name in named)}
    for name in ("one", "two"):
        (folder / name).mkdir()
    path.write_text("x: one/../app.yaml\ny: two/../app.yaml\n")
    assert watched_files([path]) == {path}
    path.write_text("hardware: {platform: generic}\n")
    assert watched_files([path]) == {path}
    assert watched_files([folder / "nothing.yaml"]) == {folder / "nothing.yaml"}


def test_standard_input_cannot_be_watched():
    run = amuros("check", "-", "--watch")
    assert run.returncode == 2
    assert "--watch waits for changes of files; standard input and pipes have none" in run.stderr
