"""Completion as the shells do it, through the scripts that `amuros completion` prints."""

import os
import pty
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
from command import amuros
from support import ROOT

from amalthea_uros.cli.main import COMMANDS

ENVIRONMENT = os.environ | {
    "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
    "PYTHONPATH": str(ROOT),
    "TERM": "xterm",
}
#: Shell -> how it is started without the set-up of this computer, and what its user writes into that.
SHELLS = {
    "bash": (["bash", "--norc", "--noprofile", "-i"], 'eval "$(amuros completion bash)"'),
    "zsh": (["zsh", "-f", "-i"], 'autoload -U compinit; compinit -u -D; eval "$(amuros completion zsh)"'),
}


def needs(shell):
    return pytest.param(shell, marks=pytest.mark.skipif(shutil.which(shell) is None, reason=f"{shell} is not installed"))


def completed(shell, text, expected, folder):
    """What a shell shows after somebody typed a text and the tab key, up to what is expected, or of 20 seconds."""
    command, set_up = SHELLS[shell]
    child, terminal = pty.fork()
    if child == 0:
        os.chdir(folder)
        os.execvpe(command[0], command, ENVIRONMENT)
    try:
        os.write(terminal, f"{set_up}; echo rea''dy\n".encode())
        read_until(terminal, "ready")
        os.write(terminal, f"{text}\t".encode())
        return read_until(terminal, expected)
    finally:
        os.close(terminal)
        os.kill(child, 9)
        os.waitpid(child, 0)


def read_until(terminal, expected):
    shown, end = "", time.monotonic() + 20
    while expected not in shown and time.monotonic() < end:
        if select.select([terminal], [], [], 0.1)[0]:
            shown += os.read(terminal, 65536).decode(errors="replace")
    return shown


CASES = [
    ("amuros migr", "amuros migrate"),
    ("amuros check unus", "unusual\\ name.amxmi"),
    ("amuros init --board sing", "--board single-core"),
    ("amuros simulate --dura", "--duration"),
    ("amuros check --profile app4", "--profile app4mc"),
]


@pytest.mark.parametrize("shell", [needs(shell) for shell in SHELLS])
@pytest.mark.parametrize(("text", "expected"), CASES)
def test_a_shell_completes(shell, text, expected, tmp_path):
    (tmp_path / "unusual name.amxmi").touch()
    assert expected in completed(shell, text, expected, tmp_path)


@pytest.mark.skipif(shutil.which("fish") is None, reason="fish is not installed")
@pytest.mark.parametrize(("text", "expected"), CASES)
def test_fish_completes(text, expected, tmp_path):
    (tmp_path / "unusual name.amxmi").touch()
    script = f"amuros completion fish | source; complete -C '{text}'"
    run = subprocess.run(
        ["fish", "-N", "-c", script], env=ENVIRONMENT, cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert expected.replace("\\ ", " ").removeprefix("--board ").removeprefix("--profile ").split("amuros ")[-1] in run.stdout


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_completes_the_command(shell):
    run = amuros("completion", shell)
    assert run.returncode == 0
    assert f"_AMUROS_COMPLETE={shell}_complete" in run.stdout


def test_commands_are_completed_without_importing_them():
    code = (
        "import sys, atexit; atexit.register(lambda: print(*sys.modules))\n"
        "from amalthea_uros.cli.main import cli; cli(prog_name='amuros')"
    )
    environment = os.environ | {"_AMUROS_COMPLETE": "bash_complete", "COMP_WORDS": "amuros ", "COMP_CWORD": "1"}
    run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    *completions, modules = run.stdout.splitlines()
    assert completions == [f"plain,{name}" for name in COMMANDS]
    assert not any(f"amalthea_uros.cli.{name}" in modules.split() for name in COMMANDS)


def test_the_shells_are_listed_if_none_is_given():
    run = amuros("completion")
    assert run.returncode == 2
    assert "completion [OPTIONS] {bash|zsh|fish}" in run.stderr.splitlines()[0]
    assert "\\" not in run.stderr
    assert [line.strip(" \t,") for line in run.stderr.splitlines()[-3:]] == ["bash", "zsh", "fish"]


def test_a_shell_that_is_not_known_is_refused():
    run = amuros("completion", "tcsh")
    assert run.returncode == 2
    assert "'tcsh' is not one of 'bash', 'zsh', 'fish'" in run.stderr
