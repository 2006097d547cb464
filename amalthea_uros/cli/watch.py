"""`--watch`: a command runs again when one of its input files changes.

Files are polled, which works on every system and network drive, and needs no library. Each run is a process of its own: it starts like
the first one, whatever the one before left behind, and an error in it ends nothing else.
"""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from functools import wraps
from os.path import realpath
from pathlib import Path
from typing import Any, NoReturn

import click

from amalthea_uros._internal.files import FileError, is_directory, is_stream, list_directory, read_bytes
from amalthea_uros._internal.limits import DESCRIPTION_SIZE
from amalthea_uros._internal.own_processes import own_command
from amalthea_uros._internal.paths import is_description
from amalthea_uros._internal.plural import counted
from amalthea_uros.cli.output import show_line
from amalthea_uros.cli.parameters import INPUT

_OPTION = "--watch"
#: Seconds between two looks at the files. A change counts when it is the same twice, because editors write in several steps.
_INTERVAL = 0.2

#: A file that a description names. It is looked for as text, because it shall be found also while the rest is being edited.
_NAMED = rb""":[ \t]*["']?([^\s"',}#]+\.(?:ya?ml|dbc))\b"""

#: What shows that a file changed, None for one that does not exist.
State = Mapping[Path, tuple[int, int, int] | None]


def repeat_on_change(callback: Callable[..., Any] | None) -> Callable[..., Any]:
    """The function of a command with a parameter `watch`, with which it never returns."""
    assert callback is not None

    @wraps(callback)
    def run(*, watch: bool, **values: Any) -> None:
        if watch:
            _repeat(_inputs(click.get_current_context()))
        callback(**values)

    return run


def _repeat(inputs: list[Path]) -> NoReturn:
    import subprocess

    words = [word for word in sys.argv[1:] if word != _OPTION]
    while True:
        before = _state(inputs)
        subprocess.run(own_command(words), check=False)
        show_line(f"watching {counted(len(before), 'file')} for changes; Ctrl-C ends it")
        changed = _wait_for_change(inputs, before)
        show_line(f"{', '.join(map(str, changed))} changed; running again")


def _inputs(context: click.Context) -> list[Path]:
    """The files and folders that a command reads, as its arguments and options name them.

    Raises
    ------
    UsageError : one of them is standard input or a pipe.
    """
    read = (context.params[p.name] for p in context.command.params if p.type is INPUT and p.name in context.params)
    paths = [path for given in read for path in (given if isinstance(given, tuple) else (given,)) if path is not None]
    if any(map(is_stream, paths)):
        raise click.UsageError(f"{_OPTION} waits for changes of files; standard input and pipes have none")
    platform = context.params.get("platform")
    return [*paths, *(path.parent / platform for path in paths if platform)]


def _wait_for_change(inputs: list[Path], before: State) -> list[Path]:
    """Wait until files differ from what they were, and nobody writes them any more; the files that differ."""
    last = before
    while True:
        time.sleep(_INTERVAL)
        now = _state(inputs)
        if now == last != before:
            return sorted(path for path in now.keys() | before.keys() if now.get(path) != before.get(path))
        last = now


def _state(inputs: list[Path]) -> State:
    return {path: _stamp(path) for path in watched_files(inputs)}


def watched_files(paths: Iterable[Path]) -> frozenset[Path]:
    """The files that paths name: themselves, the models of folders, and the files that descriptions name, such as platforms."""
    return frozenset(file for path in paths for file in _files(path))


def _files(path: Path) -> Iterable[Path]:
    from amalthea_uros.xmi.emf.files import is_model_name

    try:
        if is_directory(path):
            return [file for file in list_directory(path) if is_model_name(file)]
    except FileError:
        return [path]  # the command says what is wrong with it
    return _with_named([path])


def _with_named(waiting: list[Path]) -> Iterable[Path]:
    """Files, and those that descriptions among them name, directly or not."""
    known: dict[str, Path] = {}
    while waiting:
        path = waiting.pop()
        # A file can be named in any number of ways, by itself, too.
        if (place := realpath(path)) in known:
            continue
        known[place] = path
        if is_description(path):
            with suppress(FileError):
                named = re.findall(_NAMED, read_bytes(path, DESCRIPTION_SIZE))
                waiting += [path.parent / name.decode(errors="replace") for name in named]
    return known.values()


def _stamp(path: Path) -> tuple[int, int, int] | None:
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
