"""The containers of a .blf file: python-can passes over damaged ones without a word, and unpacks them whatever their size."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from typing import IO

from amalthea_uros._internal.files import read_up_to
from amalthea_uros._internal.limits import ADVICE, MODEL_SIZE

#: Signature and size of the header of the file.
_FILE = struct.Struct("<4sL")
#: Signature, size and version of the header, size and type of the object.
_OBJECT = struct.Struct("<4sHHLL")
#: Method of compression, size of the content.
_CONTAINER = struct.Struct("<H6xL4x")
_CONTAINER_TYPE = 10
_PLAIN, _DEFLATED = 0, 2


class TooLargeError(Exception):
    """A container is larger than any that a recorder writes; the text says what to do."""


def damages(stream: IO[bytes]) -> Iterator[str]:
    """What is wrong with the containers of a file, from its beginning.

    Raises
    ------
    TooLargeError : a container must not be unpacked.
    """
    header = stream.read(_FILE.size)
    if len(header) < _FILE.size:
        return
    read_up_to(stream, max(_FILE.unpack(header)[1] - _FILE.size, 0))
    while base := stream.read(_OBJECT.size):
        if len(base) < _OBJECT.size:
            yield "the file ends in a header"
            return
        signature, _, _, size, kind = _OBJECT.unpack(base)
        if signature != b"LOBJ" or size < _OBJECT.size:
            yield "a container does not begin with LOBJ; it and the rest are not used"
            return
        if size > MODEL_SIZE:
            raise TooLargeError(ADVICE)
        content = read_up_to(stream, size - _OBJECT.size)
        if len(content) < size - _OBJECT.size:
            yield "the file ends in a container"
        elif kind != _CONTAINER_TYPE:
            yield "a record is not a container; it is ignored"
        elif not _is_sound(content):
            yield "a container is damaged; its frames are missing"
        stream.read(size % 4)


def _is_sound(content: bytes) -> bool:
    if len(content) < _CONTAINER.size:
        return False
    method, size = _CONTAINER.unpack_from(content)
    packed = content[_CONTAINER.size :]
    if method != _DEFLATED:
        return bool(method == _PLAIN)
    unpacking = zlib.decompressobj()
    try:
        unpacked = len(unpacking.decompress(packed, min(size, MODEL_SIZE) + 1))
    except zlib.error:
        return False
    if unpacked > MODEL_SIZE or unpacking.unconsumed_tail:
        raise TooLargeError(ADVICE)
    return unpacking.eof and unpacked == size
