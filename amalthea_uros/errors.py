"""Exceptions for callers of the library; they carry findings, the words are made when they are shown."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.diagnostics import Finding


class AmurosError(Exception):
    """Base of everything that this package raises on purpose.

    Attributes
    ----------
    findings : what is wrong and where, never empty
    """

    def __init__(self, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        super().__init__(self.findings)

    def __str__(self) -> str:
        return "\n".join(map(str, self.findings))


class ReadError(AmurosError):
    """A file cannot be read as a model."""


class WriteError(AmurosError):
    """A model cannot be written: values that the metamodel does not allow, or a place that cannot be written to."""


class InvalidArgumentError(ValueError):
    """An argument that cannot be right, such as a name that does not exist; the text says what was expected."""


class UnknownError(Exception):
    """A value that cannot be determined; the text says why."""
