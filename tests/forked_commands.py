"""Lines of a shell whose `amuros` is a copy of this process.

Python and the package take longer to start than most commands to run. So the `amuros` that the shell finds is a small program: it asks
this process, which has loaded the package, for a copy of itself that has the streams, the folder and the environment of the shell.
"""

import json
import os
import select
import socket
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from typing import NoReturn

from command import become, warm_up
from effort import IS_THOROUGH

_ADDRESS = "AMUROS_OF_TESTS"
_CLIENT = f"""#!{sys.executable} -IS
import json, os, socket, sys

with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as server:
    server.connect(os.environ["{_ADDRESS}"])
    socket.send_fds(server, [json.dumps([sys.argv[1:], os.getcwd(), dict(os.environ)]).encode()], [0, 1, 2])
    sys.exit(int(server.recv(16) or 1))
"""
#: Bytes of a request: the words, the folder and the environment of a command.
_REQUEST = 1 << 18


def printed(line: str) -> str:
    """What a line prints, also as errors. A thorough run starts each command anew."""
    if IS_THOROUGH or not hasattr(socket, "SOCK_SEQPACKET"):
        scripts = str(Path(sys.executable).parent)
        return subprocess.run(
            line,
            shell=True,
            env=_environment(scripts),
            text=True,
            check=False,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        ).stdout
    warm_up()
    with TemporaryDirectory() as folder, TemporaryFile("w+b") as out, _server(f"{folder}/socket") as server:
        client = Path(folder, "amuros")
        client.write_text(_CLIENT)
        client.chmod(0o700)
        environment = _environment(folder) | {_ADDRESS: f"{folder}/socket"}
        copies = []
        with subprocess.Popen(line, shell=True, env=environment, stdout=out, stderr=out) as shell:
            while shell.poll() is None:
                if select.select([server], [], [], 0.01)[0]:
                    copies.append(_answer(server))
        for copy in copies:
            os.waitpid(copy, 0)
        out.seek(0)
        return out.read().decode()


def _environment(folder: str) -> dict[str, str]:
    scripts = str(Path(sys.executable).parent)
    return os.environ | {"PATH": os.pathsep.join((folder, scripts, os.environ["PATH"])), "NO_COLOR": "1"}


def _server(address: str) -> socket.socket:
    server = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    server.bind(address)
    server.listen()
    return server


def _answer(server: socket.socket) -> int:
    """Let a copy of this process run a command, and another one, which is returned, tell the client how that ended."""
    connection, _ = server.accept()
    with connection:
        request, streams, _, _ = socket.recv_fds(connection, _REQUEST, 3)
        teller = os.fork()
        if teller == 0:
            _run(connection, request, streams)
        for stream in streams:
            os.close(stream)
        return teller


def _run(connection: socket.socket, request: bytes, streams: list[int]) -> NoReturn:
    child = os.fork()
    if child == 0:
        words, folder, environment = json.loads(request)
        connection.close()
        os.environ.clear()
        os.environ.update(environment)
        become(words, Path(folder), streams)
    _, status = os.waitpid(child, 0)
    connection.send(str(os.waitstatus_to_exitcode(status)).encode())
    os._exit(0)
