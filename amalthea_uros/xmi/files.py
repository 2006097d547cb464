"""Bytes of model files: plain or zipped, decoded; written beside the target and renamed."""

from __future__ import annotations

import codecs
import io
import lzma
import os
import re
import tempfile
import zipfile
import zlib
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError, WriteError

#: No model comes near it (the largest published one has 6 MB); beyond, a file is refused before it fills the memory.
MAX_SIZE = 512 * 2**20

#: Name that EMF gives to the only entry of a zipped resource.
ZIP_ENTRY = "ResourceContents"

_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
#: Codecs to which a byte order mark is a character like others; files in them that have none are not told from binary ones.
_UNMARKED = frozenset({"utf-16-le", "utf-16-be"})
_MARK = "\ufeff"
_DECLARED = re.compile(rb"""<\?xml[^>]*?encoding\s*=\s*["']([A-Za-z][A-Za-z0-9._-]*)["']""")


#: What `zipfile` raises; an index error where an entry has no name.
_DAMAGED = (zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, RuntimeError, OSError, ValueError, IndexError)


@dataclass(frozen=True, slots=True)
class FileText:
    """The characters of a file and how they were stored."""

    text: str
    encoding: str = "utf-8"
    zip_entry: str | None = None


def read_text(path: Path, max_size: int = MAX_SIZE) -> FileText:
    """Characters of a model file, unpacked if it is a ZIP (told by content, as EMF does).

    Raises
    ------
    ReadError : no such file, no permission, a directory, empty, binary, too large, or a damaged archive.
    """
    data = _read_bytes(path, max_size)
    entry = None
    if data.startswith(b"PK\x03\x04"):
        entry, data = _unzip(path, data, max_size)
    encoding = _encoding(data)
    try:
        text = _decode(data, encoding)
    except (UnicodeError, LookupError) as error:
        raise _refused(
            path,
            "XMI002",
            f"this is not XML: its bytes are no {encoding} text ({error})",
            "AMALTHEA models are XML files in UTF-8, plain or zipped.",
        ) from None
    if not text or text.isspace():
        raise _refused(path, "XMI001", "the file is empty", "Check that it was written completely.")
    return FileText(text, encoding, entry)


def write_text(path: Path, content: FileText) -> None:
    """Write a file as a whole or not at all.

    Raises
    ------
    WriteError : the place cannot be written to.
    """
    data = _encode(content.text, content.encoding)
    if content.zip_entry is not None:
        data = _zip(content.zip_entry, data)
    temporary = None
    try:
        target = path.resolve()  # a link stays a link, the file behind it is replaced
        mode = target.stat().st_mode & 0o777 if target.exists() else 0o666 & ~_umask()
        descriptor, temporary = tempfile.mkstemp(prefix=f".{target.name[:40]}.", dir=target.parent)
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        Path(temporary).chmod(mode)
        Path(temporary).replace(target)
        temporary = None
    except (OSError, ValueError) as error:
        raise not_writable(path, error) from None
    finally:
        if temporary:
            with suppress(OSError):
                Path(temporary).unlink()


def is_folder(path: Path) -> bool:
    """Whether there is such a folder; of an impossible path, opening it tells what is wrong."""
    try:
        return path.is_dir()
    except OSError:
        return False


def not_writable(path: Path, error: OSError | ValueError) -> WriteError:
    """What to raise when a place cannot be written to."""
    return WriteError([Finding("XMI101", Severity.ERROR, f"the file cannot be written: {_reason(error)}", Location(path))])


def not_readable(path: Path, error: OSError | ValueError) -> ReadError:
    """What to raise when a place cannot be read."""
    return _refused(path, "XMI001", f"the file cannot be read: {_reason(error)}", "")


def _reason(error: OSError | ValueError) -> str:
    # A path with a zero byte is a ValueError.
    return getattr(error, "strerror", None) or str(error)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _read_bytes(path: Path, max_size: int) -> bytes:
    try:
        if path.is_dir():
            raise _refused(path, "XMI001", "this is a directory", "Name a model file, or load the directory as a model.")
        with path.open("rb") as stream:
            data = stream.read(max_size + 1)
    except FileNotFoundError:
        raise _refused(path, "XMI001", "there is no such file", "Check the path.") from None
    except (OSError, ValueError) as error:
        raise not_readable(path, error) from None
    if len(data) > max_size:
        raise _too_large(path, max_size)
    return data


def _unzip(path: Path, data: bytes, max_size: int) -> tuple[str, bytes]:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = [info.filename for info in archive.infolist() if not info.is_dir()]
            if len(names) != 1:
                raise _refused(
                    path,
                    "XMI001",
                    f"the archive holds {len(names)} files instead of one",
                    "Unpack it and load the folder.",
                )
            with archive.open(names[0]) as stream:
                # Never trust the size that the archive declares: stop when too much has come out.
                content = stream.read(max_size + 1)
    except _DAMAGED as error:
        raise _refused(path, "XMI001", f"the archive is damaged or not supported: {error}", "") from None
    if len(content) > max_size:
        raise _too_large(path, max_size)
    return names[0], content


def _decode(data: bytes, encoding: str) -> str:
    """The characters of a file, provided that they give these bytes again."""
    text = data.decode(encoding)
    if encoding in _UNMARKED:
        text = text.removeprefix(_MARK)
    if not encoding.startswith("utf-8"):
        text.encode()  # some encodings have lone surrogates, XML has not
        if _encode(text, encoding) != data:
            raise UnicodeError("written again, they would not be the same")
    return text


def _encode(text: str, encoding: str) -> bytes:
    # What an encoding lacks, XML can write by its number.
    return (_MARK + text if encoding in _UNMARKED else text).encode(encoding, "xmlcharrefreplace")


def _zip(entry: str, data: bytes) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        # A fixed date: the same model gives the same file.
        archive.writestr(zipfile.ZipInfo(entry), data, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def _encoding(data: bytes) -> str:
    for mark, encoding in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            return encoding
    declared = _DECLARED.match(data)
    return declared[1].decode("ascii").lower() if declared else "utf-8"


def _too_large(path: Path, max_size: int) -> ReadError:
    return _refused(
        path,
        "XMI004",
        f"the content is larger than {max_size // 2**20} MiB",
        "It is refused as a whole. If the file is trusted, raise the limit: load(path, max_size=...).",
    )


def _refused(path: Path, rule: str, message: str, help_text: str) -> ReadError:
    return ReadError([Finding(rule, Severity.ERROR, message, Location(path), help_text)])
