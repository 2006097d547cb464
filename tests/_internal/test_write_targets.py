"""Files that are written where something is already: nothing becomes another file that was not one of its own."""

import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from amalthea_uros._internal.file_writing import replacing, write_all, write_bytes
from amalthea_uros._internal.files import FileError, is_standard_output, is_stream


def write_both_ways(path, data):
    write_bytes(path, data)
    yield
    with replacing(path) as stream:
        stream.write(data + b"2")
    yield


def test_hard_links_stay_together(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    first.write_bytes(b"a long former content")
    second.hardlink_to(first)
    for _ in write_both_ways(first, b"new"):
        assert first.samefile(second)
        assert second.read_bytes().startswith(b"new")
        assert sorted(path.name for path in tmp_path.iterdir()) == ["first", "second"]


def test_a_failure_while_a_linked_file_is_overwritten_gives_it_its_content_back(tmp_path, monkeypatch):
    first, second = tmp_path / "first", tmp_path / "second"
    first.write_bytes(b"old")
    second.hardlink_to(first)
    truncated = []

    def fail(*_arguments):
        if not truncated:
            truncated.append(True)
            second.write_bytes(b"half")
            raise OSError(28, "No space left on device")
        sys.modules["shutil"].copyfileobj = copy
        return copy(*_arguments)

    copy = sys.modules["shutil"].copyfileobj
    monkeypatch.setattr("shutil.copyfileobj", fail)
    with pytest.raises(FileError, match="No space left"):
        write_bytes(first, b"new")
    assert second.read_bytes() == b"old"
    assert first.samefile(second)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["first", "second"]


@pytest.mark.skipif(os.geteuid() != 0, reason="only root gives files away")
def test_the_owner_stays(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"old")
    os.chown(path, 12345, 54321)
    for _ in write_both_ways(path, b"new"):
        assert (path.stat().st_uid, path.stat().st_gid) == (12345, 54321)


def test_a_file_of_somebody_else_is_overwritten_where_it_cannot_be_given_back(tmp_path, monkeypatch):
    if os.geteuid() != 0:
        pytest.skip("only root gives files away")
    path = tmp_path / "a"
    path.write_bytes(b"old")
    os.chown(path, 12345, 54321)

    def refuse(*_arguments):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "chown", refuse)
    write_bytes(path, b"new")
    assert (path.read_bytes(), path.stat().st_uid) == (b"new", 12345)
    assert [file.name for file in tmp_path.iterdir()] == ["a"]


def test_a_read_only_file_is_not_replaced(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"old")
    path.chmod(0o444)
    with pytest.raises(FileError, match="read-only"):
        write_bytes(path, b"new")
    with pytest.raises(FileError, match="read-only"), replacing(path):
        pass
    with pytest.raises(FileError, match="read-only"):
        write_all({tmp_path / "b": b"new", path: b"new"})
    assert [(file.name, file.read_bytes()) for file in tmp_path.iterdir()] == [("a", b"old")]


def test_a_read_only_file_system_is_the_reason_that_is_given(tmp_path, monkeypatch):
    def refuse(*_arguments, **_more):
        raise OSError(30, "Read-only file system", ".a.temporary")

    for target, name in ((os, "open"), (Path, "unlink"), (Path, "open")):
        monkeypatch.setattr(target, name, refuse)
    for write in (write_bytes, lambda path, _data: replacing(path).__enter__()):
        with pytest.raises(FileError, match="cannot be written: Read-only file system") as caught:
            write(tmp_path / "a", b"new")
        assert caught.value.path == tmp_path / "a"


def test_a_device_node_stays_one(tmp_path):
    node = tmp_path / "null"
    with suppress(PermissionError):
        os.mknod(node, 0o020666, os.makedev(1, 3))
    if not node.exists():
        pytest.skip("devices cannot be made here")
    for _ in write_both_ways(node, b"new"):
        assert node.is_char_device()


def test_an_open_file_is_written_to(tmp_path):
    """As in `-o /dev/fd/63`, which is what a shell makes of `>(...)`, also where it leads to a regular file."""
    path, link = tmp_path / "a", tmp_path / "link"
    with path.open("wb", buffering=0) as stream:
        stream.write(b"before ")
        link.symlink_to(f"/dev/fd/{stream.fileno()}")
        assert is_stream(link)
        assert not is_standard_output(link)
        inode = path.stat().st_ino
        for _ in write_both_ways(link, b"new"):
            assert path.stat().st_ino == inode
        stream.write(b" after")
    assert path.read_bytes() == b"before newnew2 after"


@pytest.mark.parametrize("name", ["/dev/stdout", "/proc/self/fd/1", "/dev/fd/1"])
def test_standard_output_that_is_a_file_gets_what_was_printed_before_too(name, tmp_path):
    code = (
        "import pathlib; from amalthea_uros._internal.file_writing import write_bytes; print('before');"
        f"write_bytes(pathlib.Path({name!r}), b'content\\n'); print('after')"
    )
    with (tmp_path / "out").open("wb") as out:
        subprocess.run([sys.executable, "-c", code], stdout=out, check=True)
    assert (tmp_path / "out").read_text() == "before\ncontent\nafter\n"


def test_an_open_file_that_can_only_be_read_is_refused(tmp_path):
    (tmp_path / "a").write_bytes(b"old")
    with (tmp_path / "a").open("rb") as stream, pytest.raises(FileError):
        write_bytes(tmp_path / f"/dev/fd/{stream.fileno()}", b"new")
