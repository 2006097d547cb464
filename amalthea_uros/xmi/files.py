"""Model files: plain or zipped, in the encoding that their bytes or their XML declaration state."""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from amalthea_uros._internal import files
from amalthea_uros._internal.files import FileEncodingError, FileError, FileTooLargeError
from amalthea_uros._internal.limits import ADVICE, MODEL_ELEMENTS, MODEL_SIZE
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError, WriteError

#: Name that EMF gives to the only entry of a zipped resource.
ZIP_ENTRY = "ResourceContents"

#: How the directory entry of a packed file begins. The bytes occur in packed data by chance, but not that often.
_DIRECTORY_ENTRY, _MOST_ENTRIES = b"PK\x01\x02", 1000
_UNPACK = "Unpack it and load the directory."
#: How EMF compresses. Others unpack without a limit to what comes out at a time: a few bytes of bzip2 become a megabyte.
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_DECLARED = re.compile(rb"""<\?xml[^>]*?encoding\s*=\s*["']([A-Za-z][A-Za-z0-9._-]*)["']""")

#: What `zipfile` raises; an index error where an entry has no name.
_DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, OSError, ValueError, IndexError)


@dataclass(frozen=True, slots=True)
class FileText:
    """The characters of a file and how they were stored."""

    text: str
    encoding: str = "utf-8"
    zip_entry: str | None = None


def read_text(path: Path, max_size: int = MODEL_SIZE) -> FileText:
    """Characters of a model file, unpacked if it is a ZIP (recognised by content, as EMF does).

    Parameters
    ----------
    max_size : largest size in bytes, unpacked; a larger one than usual allows more elements in proportion

    Raises
    ------
    ReadError : file not found, no permission, a directory, empty, binary, too large, or a damaged archive.
    """
    try:
        return _read_text(path, max_size)
    except FileError as error:
        raise not_readable(error) from None


def write_text(path: Path, content: FileText) -> None:
    """Write a model file whole or not at all.

    Raises
    ------
    WriteError : the file cannot be written.
    """
    try:
        files.write_bytes(path, _data(content))
    except FileError as error:
        raise not_writable(error) from None


def write_texts(contents: Mapping[Path, FileText], removed: Collection[Path] = ()) -> None:
    """Write several model files and remove others, all of that or nothing.

    Raises
    ------
    WriteError : a file cannot be written; all files are as they were.
    """
    try:
        files.write_all({path: _data(content) for path, content in contents.items()}, removed)
    except FileError as error:
        raise not_writable(error) from None


def not_readable(error: FileError) -> ReadError:
    """A failure to read a file as the exception of this library."""
    rule = {FileEncodingError: "XMI002", FileTooLargeError: "XMI004"}.get(type(error), "XMI001")
    return ReadError([Finding(rule, Severity.ERROR, error.reason, Location(error.path), error.advice)])


def not_writable(error: FileError) -> WriteError:
    """A failure to write a file as the exception of this library."""
    return WriteError([Finding("XMI101", Severity.ERROR, error.reason, Location(error.path), error.advice)])


def _data(content: FileText) -> bytes:
    # A character that the encoding lacks is written as a character reference of XML.
    data = files.encode(content.text, content.encoding, "xmlcharrefreplace")
    return data if content.zip_entry is None else _zip(content.zip_entry, data)


def _read_text(path: Path, max_size: int) -> FileText:
    data = files.read_bytes(path, max_size)
    entry = None
    if data.startswith(b"PK\x03\x04"):
        entry, data = _unzip(path, data, max_size)
    encoding = files.marked_encoding(data) or _declared_encoding(data)
    try:
        text = files.decode(data, encoding)
    except (UnicodeError, LookupError) as error:
        advice = "AMALTHEA models are XML files in UTF-8, plain or zipped."
        raise FileEncodingError(path, f"not XML: the content is not valid {encoding} text ({error})", advice) from None
    if not text or text.isspace():
        raise FileError(path, "the file is empty", "Check that it was written completely.")
    _check_elements(path, text, MODEL_ELEMENTS * max(MODEL_SIZE, max_size) // MODEL_SIZE)
    return FileText(text, encoding, entry)


def _check_elements(path: Path, text: str, limit: int) -> None:
    """Refuse a model with too many elements before any object is made: a hundred kilobytes of ZIP may hold ten million."""
    # Comments count too, since they are kept.
    if text.count("<") - text.count("</") > limit:
        raise FileTooLargeError(path, f"the file has more than {limit:,} elements", ADVICE)


def _unzip(path: Path, data: bytes, max_size: int) -> tuple[str, bytes]:
    if data.count(_DIRECTORY_ENTRY) > _MOST_ENTRIES:
        raise FileError(path, f"the archive contains more than {_MOST_ENTRIES:,} files, expected one", _UNPACK)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = [info for info in archive.infolist() if not info.is_dir()]
            if len(entries) != 1:
                raise FileError(path, f"the archive contains {len(entries)} files, expected one", _UNPACK)
            if entries[0].compress_type not in _METHODS:
                reason = "the archive is compressed by a method that AMALTHEA tools do not use"
                raise FileError(path, reason, "Compress it again with the method Deflate.")
            with archive.open(entries[0]) as stream:
                # Never trust the size that the archive declares: stop when too much has come out.
                content = files.read_up_to(stream, max_size + 1)
    except _DAMAGED as error:
        raise FileError(path, f"the archive is damaged or not supported: {error}") from None
    if len(content) > max_size:
        raise files.larger(path, max_size, "the unpacked content")
    return entries[0].filename, content


def _zip(entry: str, data: bytes) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        # A fixed date: the same model gives the same file.
        archive.writestr(zipfile.ZipInfo(entry), data, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def _declared_encoding(data: bytes) -> str:
    declared = _DECLARED.match(data)
    return declared[1].decode("ascii").lower() if declared else "utf-8"
