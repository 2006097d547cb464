"""The command `amuros` in a process of its own, as its user starts it.

Python and the package take longer to start than most commands to run: where the system allows it, the process is a copy of this one,
which has loaded them, and what they load and compile when they run for the first time. A thorough run starts each command anew.
"""

import os
import runpy
import subprocess
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from typing import IO, NoReturn

from click import Context
from click.testing import CliRunner
from effort import IS_THOROUGH
from shared_analyses import share

SAMPLE = Path(__file__).parents[1] / "samples" / "bodas-test-advanced.yaml"


def amuros(*arguments: object, given: str = "", cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command to its end, with a text at its standard input."""
    words = list(map(str, arguments))
    if IS_THOROUGH or not hasattr(os, "fork"):
        command = [sys.executable, "-m", "amalthea_uros", *words]
        return subprocess.run(command, input=given, capture_output=True, check=False, encoding="utf-8", cwd=cwd)
    warm_up()
    reader, writer = os.pipe()
    with TemporaryFile("w+b") as out, TemporaryFile("w+b") as err:
        child = os.fork()
        if child == 0:
            os.close(writer)
            become(words, cwd, (reader, out.fileno(), err.fileno()))
        os.close(reader)
        with suppress(BrokenPipeError), os.fdopen(writer, "wb") as stream:
            stream.write(given.encode())
        _, status = os.waitpid(child, 0)
        return subprocess.CompletedProcess(words, os.waitstatus_to_exitcode(status), _text(out), _text(err))


@cache
def warm_up() -> None:
    """Load what commands load."""
    from amalthea_uros.cli.main import COMMANDS, cli

    for command in COMMANDS:
        cli.get_command(Context(cli), command)
    with TemporaryDirectory() as folder:
        for words in ("analyze", f"build -o {folder}/app.amxmi", "check", "simulate --duration 10ms"):
            command, *options = words.split()
            outcome = CliRunner().invoke(cli, [command, str(SAMPLE), *options])
            assert outcome.exit_code == 0, outcome.output
        # The schema of XML is read only where it is violated.
        wrong = Path(folder, "wrong.amxmi")
        wrong.write_text(SAMPLE.with_suffix(".amxmi").read_text().replace('unit="ms"', 'unit="hours"', 1))
        assert CliRunner().invoke(cli, ["check", str(wrong)]).exit_code == 1


def become(words: list[str], cwd: Path | None, streams: Sequence[int]) -> NoReturn:
    """What `python -m amalthea_uros` does in this process, with these standard streams."""
    try:
        if cwd is not None:
            os.chdir(cwd)
        for number, stream in enumerate(streams):
            os.dup2(stream, number)
        sys.stdin, sys.stdout = open(0), open(1, "w")  # noqa: SIM115 - open up to the end of the process
        # Errors appear line by line, as those of a new process do.
        sys.stderr = open(2, "w", buffering=1)  # noqa: SIM115
        sys.argv = ["amuros", *words]
        share()
        runpy.run_module("amalthea_uros", run_name="__main__", alter_sys=True)
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
    finally:
        os._exit(1)


def _text(file: IO[bytes]) -> str:
    file.seek(0)
    return file.read().decode().replace("\r\n", "\n")
