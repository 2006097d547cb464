"""Files that every room reads and writes: nothing is half written, nothing is silently decoded wrongly."""

import os

import pytest

from amalthea_uros._internal.file_writing import write_all, write_bytes
from amalthea_uros._internal.files import FileError, FileFlaw, decode, encode, marked_encoding, read_bytes, read_text


def test_text_keeps_its_line_ends(tmp_path):
    (tmp_path / "a.txt").write_bytes(b"gr\xc3\xb6\xc3\x9fer\r\n")
    assert read_text(tmp_path / "a.txt", 100) == "größer\r\n"


def test_a_byte_order_mark_is_not_part_of_the_text(tmp_path):
    (tmp_path / "a.txt").write_bytes(b"\xef\xbb\xbfa")
    assert read_text(tmp_path / "a.txt", 100) == "a"


def test_what_is_not_utf_8_is_refused(tmp_path):
    (tmp_path / "a.txt").write_bytes(b"ab\xff")
    with pytest.raises(FileError, match=r"not UTF-8 \(byte 2\)") as raised:
        read_text(tmp_path / "a.txt", 100)
    assert raised.value.flaw is FileFlaw.ENCODING


def test_the_limit_is_the_largest_size_that_is_read(tmp_path):
    (tmp_path / "a").write_bytes(b"12345")
    assert read_bytes(tmp_path / "a", 5) == b"12345"
    with pytest.raises(FileError) as raised:
        read_bytes(tmp_path / "a", 4)
    assert raised.value.flaw is FileFlaw.SIZE


@pytest.mark.parametrize("name", ["none", "a\0b", "a" * 300])
def test_a_file_that_cannot_be_read(name, tmp_path):
    with pytest.raises(FileError):
        read_bytes(tmp_path / name, 100)


def test_a_write_that_fails_leaves_the_old_content_and_no_other_file(tmp_path, monkeypatch):
    def full(_descriptor):
        raise OSError(28, "No space left on device")

    (tmp_path / "a").write_bytes(b"old")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(FileError, match="No space left on device"):
        write_bytes(tmp_path / "a", b"new")
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("a", b"old")]


@pytest.mark.parametrize("number", [1, 2])
def test_who_interrupts_while_a_file_is_made_leaves_nothing_behind(number, tmp_path, monkeypatch):
    opened = os.open

    def interrupted(path, flags, *mode, **options):
        descriptor = opened(path, flags, *mode, **options)
        if flags & os.O_CREAT:
            os.close(descriptor)
            raise KeyboardInterrupt
        return descriptor

    monkeypatch.setattr(os, "open", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_all({tmp_path / str(name): b"new" for name in range(number)})
    assert not list(tmp_path.iterdir())


def test_a_write_keeps_permissions_and_symbolic_links(tmp_path):
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_bytes(b"old")
    target.chmod(0o640)
    link.symlink_to(target)
    write_bytes(link, b"new")
    assert link.is_symlink()
    assert target.read_bytes() == b"new"
    assert target.stat().st_mode & 0o777 == 0o640


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16-le", "utf-16-be"])
def test_a_byte_order_mark_tells_the_encoding(encoding):
    data = encode("<ä/>", encoding)
    assert (marked_encoding(data) or "utf-8") == encoding
    assert decode(data, encoding) == "<ä/>"


def test_bytes_that_would_not_come_back_are_refused():
    # UTF-7 has several spellings of one character; only one of them is written.
    assert decode(b"a+AOQ-", "utf-7") == "aä"
    with pytest.raises(UnicodeError):
        decode(b"+AGE-", "utf-7")


def test_a_pipe_or_a_device_is_written_to_and_stays_what_it_is(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_bytes(pipe, b"content")
    assert os.read(reader, 100) == b"content"
    os.close(reader)
    assert pipe.is_fifo()


def test_several_files_and_a_pipe_are_written_together(tmp_path):
    pipe, kept = tmp_path / "pipe", tmp_path / "kept"
    os.mkfifo(pipe)
    kept.write_bytes(b"old")
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_all({pipe: b"content", kept: b"new", tmp_path / "other": b"more"})
    assert os.read(reader, 100) == b"content"
    os.close(reader)
    assert pipe.is_fifo()
    assert (kept.read_bytes(), (tmp_path / "other").read_bytes()) == (b"new", b"more")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["kept", "other", "pipe"]


@pytest.mark.parametrize("others", [0, 1])
def test_a_circle_of_symbolic_links_is_refused(tmp_path, others):
    circle = tmp_path / "circle"
    circle.symlink_to(circle)
    with pytest.raises(FileError, match="levels of symbolic links"):
        write_all({circle: b"new", **{tmp_path / str(number): b"" for number in range(others)}})
    assert [path.name for path in tmp_path.iterdir()] == ["circle"]
