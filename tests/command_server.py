"""A process of which commands are copies, so that they need not load Python and the package, which takes longer than most of them run.

It is a process of its own and not that of the tests, as a copy of that one, with all tests, takes a multiple of the time.
"""

import gc
import marshal
import os
import runpy
import signal
import socket
import subprocess
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from select import select
from tempfile import TemporaryDirectory
from typing import NoReturn

import shared_analyses
from click import Context
from click.testing import CliRunner

from amalthea_uros.cli.process import GARBAGE_THRESHOLD

SAMPLES = Path(__file__).parents[1] / "samples"
SAMPLE = SAMPLES / "bodas-test-advanced.yaml"

#: Where there is no such process, each command starts anew.
IS_POSSIBLE = hasattr(os, "fork") and hasattr(socket, "SOCK_SEQPACKET")

#: What a shell finds as `amuros`.
CLIENT = """#!{python} -IS
# Modules of Python that are not built in would take half of the time.
import marshal, os, sys
from _socket import AF_UNIX, SCM_RIGHTS, SOCK_SEQPACKET, SOL_SOCKET, socket

server = socket(AF_UNIX, SOCK_SEQPACKET)
server.connect({address!r})
streams = b"".join([number.to_bytes(4, sys.byteorder) for number in (0, 1, 2)])
request = marshal.dumps((sys.argv[1:], os.getcwd(), dict(os.environ)))
server.sendmsg([request], [(SOL_SOCKET, SCM_RIGHTS, streams)])
sys.exit(int(server.recv(16) or 1))
"""
#: Bytes of a request: the words, the folder and the environment of a command.
_REQUEST = 1 << 18


@cache
def address() -> Path:
    """Where the process listens, which ends with this one; it is started when it is needed."""
    shared_analyses.FOLDER.mkdir(exist_ok=True)
    folder = shared_analyses.FOLDER / f"commands-{os.getpid()}"
    folder.mkdir()
    listening = folder / "socket"
    client = folder / "amuros"
    client.write_text(CLIENT.format(python=sys.executable, address=str(listening)))
    client.chmod(0o700)
    process = subprocess.Popen([sys.executable, __file__, listening], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    _kept.append(process)
    assert process.stdout is not None
    assert process.stdout.readline() == b"ready\n"
    return listening


#: The standard input of a process would end with the object.
_kept: list[subprocess.Popen[bytes]] = []


def started(words: Sequence[str], folder: Path, streams: Sequence[int]) -> socket.socket:
    """What will receive how a command ends that is started with standard streams."""
    connection = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    connection.connect(str(address()))
    socket.send_fds(connection, [marshal.dumps((words, str(folder), dict(os.environ)))], streams)
    return connection


@cache
def warm_up() -> None:
    """Load what commands load, once in a process."""
    from amalthea_uros.cli.main import COMMANDS, cli

    for command in COMMANDS:
        cli.get_command(Context(cli), command)
    with TemporaryDirectory() as folder:
        for words in (
            f"analyze {SAMPLE}",
            f"analyze {SAMPLES}/two-controllers-drive.yaml",
            f"build {SAMPLE} -o {folder}/app.amxmi",
            f"check {SAMPLE}",
            f"diff {folder}/app.amxmi {folder}/app.amxmi",
            f"report {SAMPLE} -o {folder}/report.html --duration 10ms",
            f"simulate {SAMPLE} --duration 10ms",
        ):
            outcome = CliRunner().invoke(cli, words.split())
            assert outcome.exit_code == 0, outcome.output
        # The schema of XML is read only where it is violated.
        wrong = Path(folder, "wrong.amxmi")
        wrong.write_text(SAMPLE.with_suffix(".amxmi").read_text().replace('unit="ms"', 'unit="hours"', 1))
        assert CliRunner().invoke(cli, ["check", str(wrong)]).exit_code == 1


def serve(listening: str) -> None:
    """Start commands as long as somebody has the other end of the standard input."""
    gc.set_threshold(GARBAGE_THRESHOLD)
    warm_up()
    shared_analyses.share()
    woken, wake = os.pipe()
    os.set_blocking(wake, False)
    # The end of a copy is a byte in a pipe, for which one can wait beside everything else.
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.set_wakeup_fd(wake)
    clients: dict[int, socket.socket] = {}
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as server:
        server.bind(listening)
        server.listen()
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        while sys.stdin not in (ready := select([server, woken, sys.stdin], [], [])[0]):
            if woken in ready:
                os.read(woken, 4096)
                _tell_ends(clients)
            if server in ready:
                _start(server, clients)


def _start(server: socket.socket, clients: dict[int, socket.socket]) -> None:
    """Let a copy of this process run a command, for a client that is noted by the number of the copy."""
    connection, _ = server.accept()
    request, streams, _, _ = socket.recv_fds(connection, _REQUEST, 3)
    child = os.fork()
    if child == 0:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        server.close()
        for other in (connection, *clients.values()):
            other.close()
        words, folder, environment = marshal.loads(request)
        os.environ.clear()
        os.environ.update(environment)
        _become(words, folder, streams)
    clients[child] = connection
    for stream in streams:
        os.close(stream)


def _tell_ends(clients: dict[int, socket.socket]) -> None:
    """Tell the clients of the copies that have ended how they did."""
    while clients:
        child, status = os.waitpid(-1, os.WNOHANG)
        if child == 0:
            return
        # A client that is no longer there needs no answer.
        with clients.pop(child) as connection, suppress(OSError):
            connection.send(str(os.waitstatus_to_exitcode(status)).encode())


def _become(words: Sequence[str], folder: str, streams: Sequence[int]) -> NoReturn:
    """What `python -m amalthea_uros` does in this process, with these standard streams."""
    try:
        os.chdir(folder)
        for number, stream in enumerate(streams):
            os.dup2(stream, number)
            os.close(stream)
        sys.stdin, sys.stdout = open(0), open(1, "w")  # noqa: SIM115 - open up to the end of the process
        # Errors appear line by line, as those of a new process do.
        sys.stderr = open(2, "w", buffering=1)  # noqa: SIM115
        sys.argv = ["amuros", *words]
        runpy.run_module("amalthea_uros", run_name="__main__", alter_sys=True)
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
    finally:
        os._exit(1)


if __name__ == "__main__":
    serve(sys.argv[1])
