"""Model files: plain or zipped, in the encoding that their bytes or their XML declaration state."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from pathlib import Path

from amalthea_uros._internal import files
from amalthea_uros._internal.file_writing import write_all, write_bytes
from amalthea_uros._internal.files import FileError, FileFlaw
from amalthea_uros._internal.limits import ADVICE, MODEL_ELEMENTS, MODEL_SIZE
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError, WriteError
from amalthea_uros.metamodel.source import FileText

#: What the suffixes of model files begin with: in ITEA versions, sub-models have suffixes such as `.amxmi-sw`.
SUFFIX = ".amxmi"

_SUFFIXES = re.compile(r"\.amxmi(?:-[a-z]+)?")

#: Name that EMF gives to the only entry of a zipped resource.
ZIP_ENTRY = "ResourceContents"

_SHORTEST_ELEMENT = len("<a/>")
_COUNTED_AT_ONCE = 2**18

_DECLARED = re.compile(rb"""<\?xml[^>]*?encoding\s*=\s*["']([A-Za-z][A-Za-z0-9._-]*)["']""")


def is_model_name(path: Path) -> bool:
    """Whether the name of a file is that of a model."""
    return _SUFFIXES.fullmatch(path.suffix) is not None


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
        write_bytes(path, _data(content))
    except FileError as error:
        raise not_writable(error) from None


def write_texts(contents: Mapping[Path, FileText], removed: Collection[Path] = ()) -> None:
    """Write several model files and remove others, all of that or nothing.

    Raises
    ------
    WriteError : a file cannot be written; all files are as they were.
    """
    try:
        write_all({path: _data(content) for path, content in contents.items()}, removed)
    except FileError as error:
        raise not_writable(error) from None


def not_readable(error: FileError) -> ReadError:
    """A failure to read a file as the exception of this library."""
    rule = {FileFlaw.ENCODING: "XMI002", FileFlaw.SIZE: "XMI004"}.get(error.flaw, "XMI001")
    return ReadError([Finding(rule, Severity.ERROR, error.reason, Location(error.path), error.advice)])


def not_writable(error: FileError) -> WriteError:
    """A failure to write a file as the exception of this library."""
    return WriteError([Finding("XMI101", Severity.ERROR, error.reason, Location(error.path), error.advice)])


def _data(content: FileText) -> bytes:
    # A character that the encoding lacks is written as a character reference of XML.
    data = files.encode(content.text, content.encoding, "xmlcharrefreplace")
    if content.zip_entry is None:
        return data
    from amalthea_uros.xmi.emf.archives import packed

    return packed(content.zip_entry, data)


def _read_text(path: Path, max_size: int) -> FileText:
    data = files.read_bytes(path, max_size)
    entry = None
    if data.startswith(b"PK\x03\x04"):
        from amalthea_uros.xmi.emf.archives import unpacked

        entry, data = unpacked(path, data, max_size)
    encoding = files.marked_encoding(data) or _declared_encoding(data)
    try:
        text = files.decode(data, encoding) if encoding != "utf-8" else data
        if text is data and not data.isascii():
            files.check_utf8(data)
    except (UnicodeError, LookupError) as error:
        advice = "AMALTHEA models are XML files in UTF-8, plain or zipped."
        reason = f"not XML: the content is not valid {encoding} text ({error})"
        raise FileError(path, reason, advice, FileFlaw.ENCODING) from None
    content = FileText(text, encoding, entry)
    utf8 = content.utf8
    if not utf8 or utf8.isspace():
        raise FileError(path, "the file is empty", "Check that it was written completely.")
    _check_elements(path, utf8, MODEL_ELEMENTS * max(MODEL_SIZE, max_size) // MODEL_SIZE)
    return content


def _check_elements(path: Path, utf8: bytes, limit: int) -> None:
    """Refuse a model with too many elements before any object is made: a hundred kilobytes of ZIP may hold ten million."""
    # Comments count too, since they are kept. Tags are counted only as far as the rest may make a difference, because it takes long.
    tags = at = 0
    while at < len(utf8) and tags + (len(utf8) - at) / _SHORTEST_ELEMENT > limit:
        tags += utf8.count(b"<", at, at + _COUNTED_AT_ONCE)
        at += _COUNTED_AT_ONCE
    if tags > limit and tags - utf8.count(b"</") > limit:
        raise FileError(path, f"the file has more than {limit:,} elements", ADVICE, FileFlaw.SIZE)


def _declared_encoding(data: bytes) -> str:
    declared = _DECLARED.match(data)
    return declared[1].decode("ascii").lower() if declared else "utf-8"
