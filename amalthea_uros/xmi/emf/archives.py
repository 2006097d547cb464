"""ZIP archives with one entry, as EMF writes them; apart from other files, because most models are not packed."""

from __future__ import annotations

import io
import zipfile
import zlib
from pathlib import Path

from amalthea_uros._internal import files
from amalthea_uros._internal.files import FileError

#: How the directory entry of a packed file begins. The bytes occur in packed data by chance, but not that often.
_DIRECTORY_ENTRY, _MOST_ENTRIES = b"PK\x01\x02", 1000
_UNPACK = "Unpack it and load the directory."
#: How EMF compresses. Others unpack without a limit to what comes out at a time: a few bytes of bzip2 become a megabyte.
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)

#: What `zipfile` raises.
_DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, OSError, ValueError)


def unpacked(path: Path, data: bytes, max_size: int) -> tuple[str, bytes]:
    """The name and the content of the only entry.

    Raises
    ------
    FileError : the archive is damaged, has several entries, or is too large.
    """
    if data.count(_DIRECTORY_ENTRY) > _MOST_ENTRIES:
        raise FileError(path, f"the archive contains more than {_MOST_ENTRIES:,} files, expected one", _UNPACK)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            if not all(info.filename for info in archive.infolist()):
                raise FileError(path, "the archive contains a file without a name", "Pack the model again.")
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


def packed(entry: str, data: bytes) -> bytes:
    """An archive with one entry."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        # A fixed date: the same model gives the same file.
        archive.writestr(zipfile.ZipInfo(entry), data, zipfile.ZIP_DEFLATED)
    return stream.getvalue()
