"""The command `amuros` in a process of its own, as its user starts it.

Where the system allows it, it is a copy of a process which has loaded the package. A thorough run starts each command anew.
"""

import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO

from command_server import IS_POSSIBLE, address, started
from effort import IS_THOROUGH

IS_COPY = IS_POSSIBLE and not IS_THOROUGH


def amuros(*arguments: object, given: str = "", cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command to its end, with a text at its standard input."""
    words = list(map(str, arguments))
    if not IS_COPY:
        command = [sys.executable, "-m", "amalthea_uros", *words]
        return subprocess.run(command, input=given, capture_output=True, check=False, encoding="utf-8", cwd=cwd)
    reader, writer = os.pipe()
    with TemporaryFile("w+b") as out, TemporaryFile("w+b") as err:
        with started(words, cwd or Path.cwd(), (reader, out.fileno(), err.fileno())) as command:
            os.close(reader)
            with suppress(BrokenPipeError), os.fdopen(writer, "wb") as stream:
                stream.write(given.encode())
            status = int(command.recv(16))
        return subprocess.CompletedProcess(words, status, _text(out), _text(err))


def printed(line: str) -> str:
    """What a line of a shell prints, also as errors."""
    scripts = str(Path(sys.executable).parent)
    folders = [str(address().parent), scripts] if IS_COPY else [scripts]
    environment = os.environ | {"PATH": os.pathsep.join((*folders, os.environ["PATH"])), "NO_COLOR": "1"}
    return subprocess.run(
        line, shell=True, env=environment, text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    ).stdout


def _text(file: IO[bytes]) -> str:
    file.seek(0)
    return file.read().decode().replace("\r\n", "\n")
