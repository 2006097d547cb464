"""Files of any kind are written whole or not at all."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from amalthea_uros._internal.files import IMPOSSIBLE, FileError, descriptor_of, forget_files, is_stream, mode_of, not_writable


def write_bytes(path: Path, data: bytes) -> None:
    """Write a file whole or not at all: beside the target first, then renamed; write to a pipe, a device or an open file itself.

    Raises
    ------
    FileError : the file cannot be written; a former content is untouched.
    """
    write_all({path: data})


def write_all(contents: Mapping[Path, bytes], removed: Collection[Path] = ()) -> None:
    """Write several files and remove others, all of that or nothing; write to pipes, devices and open files themselves, at last.

    A file keeps its permissions, its owner and its hard links; one that is read-only is not replaced.

    Raises
    ------
    FileError : a file cannot be written; all files are as they were.
    """
    with ExitStack() as undo:
        streams = {path: data for path, data in contents.items() if is_stream(path)}
        staged = {path: _staged(path, data, undo) for path, data in contents.items() if path not in streams}
        # A single change happens or not, and needs no way back, unless a file is overwritten rather than replaced.
        is_single = len(contents) + len(removed) == 1 and not any(_stays(path, new) for path, new in staged.items())
        former = {} if is_single else {path: _copied(path, undo) for path in (*staged, *removed)}
        for path in (*staged, *removed):
            if path in former:
                undo.callback(_restore, path, former[path])
            try:
                if path in staged:
                    _put(staged[path], path)
                else:
                    path.unlink(missing_ok=True)
            except OSError as error:
                raise not_writable(path, error) from None
        for path, data in streams.items():
            try:
                with _open_stream(path) as stream:
                    stream.write(data)
            except OSError as error:
                raise not_writable(path, error) from None
        undo.pop_all()
        forget_files()
        for copy in filter(None, former.values()):
            copy.unlink(missing_ok=True)


@contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """A stream whose content becomes that of a file once the block ends; after an exception the file is as it was.

    A pipe, a device or an open file is written itself.

    Raises
    ------
    FileError : the file cannot be written.
    """
    if is_stream(path):
        try:
            stream = _open_stream(path)
        except OSError as error:
            raise not_writable(path, error) from None
        with stream:
            yield stream
        return
    with ExitStack() as undo:
        temporary = _staged(path, b"", undo)
        with temporary.open("wb") as stream:
            yield stream
            try:
                stream.flush()
                os.fsync(stream.fileno())
            except OSError as error:
                raise not_writable(path, error) from None
        former = _copied(path, undo) if _stays(path, temporary) else None
        if former is not None:
            undo.callback(_restore, path, former)
        try:
            _put(temporary, path)
        except OSError as error:
            raise not_writable(path, error) from None
        undo.pop_all()
        forget_files()
        if former is not None:
            former.unlink(missing_ok=True)


def check_writable(path: Path) -> None:
    """Find out early whether a file can be written; it is left as it is.

    Raises
    ------
    FileError : the file cannot be written.
    """
    if not is_stream(path):
        with ExitStack() as undo:
            _staged(path, b"", undo)


def result_path(path: Path, *, is_complete: bool) -> Path:
    """Where a result is written: one that is not complete, as after an interruption, never replaces a former one.

    It is written beside it, as `runs.partial.csv`; a pipe, a device or an open file gets it itself.
    """
    return path if is_complete or is_stream(path) else path.with_suffix(f".partial{path.suffix}")


def _open_stream(path: Path) -> BinaryIO:
    """A pipe or a device, or an open file once more, so that closing it here does not close it for others."""
    descriptor = descriptor_of(path)
    if descriptor is None:
        return path.open("wb")
    for stream in filter(None, (sys.stdout, sys.stderr)):
        stream.flush()
    return os.fdopen(os.dup(descriptor), "wb")


def _staged(path: Path, data: bytes, undo: ExitStack) -> Path:
    """A temporary file beside a file, with what is to be its content."""
    mode = mode_of(path)
    if mode is not None and stat.S_ISDIR(mode):
        raise FileError(path, "the file cannot be written: it is a directory")
    if mode is not None and not mode & 0o222:
        raise FileError(path, "the file cannot be written: it is read-only", "Allow writing it, or write another file.")
    try:
        temporary = _beside(path, undo)
        _write_new(temporary, data)
        _give_owner(temporary, path)
        temporary.chmod(0o666 & ~_umask() if mode is None else mode & 0o777)
    except IMPOSSIBLE as error:
        raise not_writable(path, error) from None
    return temporary


def _give_owner(temporary: Path, path: Path) -> None:
    """Give a file the owner of the one that it replaces, where that is allowed."""
    with suppress(FileNotFoundError, PermissionError):
        former, new = path.stat(), temporary.stat()
        if (former.st_uid, former.st_gid) != (new.st_uid, new.st_gid):
            os.chown(temporary, former.st_uid, former.st_gid)


def _stays(path: Path, staged: Path) -> bool:
    """Whether a file is overwritten, because replacing it would cut its hard links or change its owner."""
    try:
        former, new = path.stat(), staged.stat()
    except OSError:
        return False
    return former.st_nlink > 1 or (former.st_uid, former.st_gid) != (new.st_uid, new.st_gid)


def _put(staged: Path, path: Path) -> None:
    """Give a file the content that was staged; at a symbolic link, the file to which it leads."""
    target = path.resolve()
    if not _stays(target, staged):
        staged.replace(target)
        return
    from shutil import copyfileobj

    with staged.open("rb") as new, target.open("r+b") as old:
        copyfileobj(new, old)
        old.truncate()
        old.flush()
        os.fsync(old.fileno())
    staged.unlink()


def _copied(path: Path, undo: ExitStack) -> Path | None:
    """A copy beside a file, None if it does not exist."""
    from shutil import copystat

    try:
        if not path.exists():
            return None
        copy = _beside(path, undo)
        _write_new(copy, path.read_bytes())
        copystat(path, copy)
    except OSError as error:
        raise not_writable(path, error) from None
    return copy


def _beside(path: Path, undo: ExitStack) -> Path:
    temporary = _name_beside(path.resolve())
    undo.callback(_remove, temporary)
    return temporary


def _remove(temporary: Path) -> None:
    """Remove a temporary file; where that fails, as in a read-only file system, what failed before is what the user has to know."""
    with suppress(OSError):
        temporary.unlink(missing_ok=True)


def _name_beside(target: Path) -> Path:
    """The path of a temporary file, which is known before the file exists, so that it can be removed whenever somebody interrupts."""
    return target.parent / f".{target.name[:40]}.{os.urandom(8).hex()}"


def _write_new(path: Path, data: bytes) -> None:
    """Write a file that nobody else may read yet."""
    with open(path, "xb", opener=lambda name, flags: os.open(name, flags, 0o600)) as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())


def _restore(path: Path, former: Path | None) -> None:
    """Give a file its former content, or let there be no file again."""
    with suppress(OSError):
        if former is None:
            path.unlink(missing_ok=True)
        elif former.exists():
            _put(former, path)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
