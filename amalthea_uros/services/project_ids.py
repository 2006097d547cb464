"""Namespaces for the ids of an INCHRON project."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from uuid import UUID, uuid5

from amalthea_uros._internal.files import STANDARD_INPUT, FileError, read_bytes
from amalthea_uros._internal.limits import MODEL_SIZE
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.inchron.ids import NAMESPACE


def hashed(paths: Sequence[Path]) -> UUID:
    """The namespace of ids that depends on the content of files.

    Raises
    ------
    InvalidArgumentError : a file cannot be read.
    """
    result = NAMESPACE
    for path in paths:
        try:
            content = b"" if path == STANDARD_INPUT else read_bytes(path, MODEL_SIZE)
        except FileError as error:
            raise InvalidArgumentError(f"{path} cannot be read: {error.reason}") from None
        result = uuid5(result, content.hex())
    return result


def valued(text: str) -> UUID:
    """The namespace of ids that depends on a text."""
    return uuid5(NAMESPACE, text)
