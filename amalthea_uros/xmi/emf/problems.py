"""Problems in a file: those that are reported once with their number, and those because of which it cannot be read at all."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path
from xml.parsers import expat

from amalthea_uros._internal.similar import Suggestions
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.source import FileText, SourceText


class CollectedFinding:
    """A finding about the tag at an offset (in bytes of UTF-8) or one of its attributes, with the number of its occurrences."""

    __slots__ = ("attribute", "count", "help", "message", "offset", "rule", "severity")

    def __init__(self, rule: str, severity: Severity, message: str, help_text: str, offset: int, attribute: str = "") -> None:
        self.rule = rule
        self.severity = severity
        self.message = message
        self.help = help_text
        self.offset = offset
        self.attribute = attribute
        self.count = 1

    def finding(self, path: Path, source: SourceText) -> Finding:
        """The finding, at the first occurrence."""
        where = location(path, source, self.offset, self.attribute)
        times = f" ({self.count} times, this is the first)" if self.count > 1 else ""
        return Finding(self.rule, self.severity, self.message + times, where, self.help)


class FindingCollector:
    """The problems of one file."""

    def __init__(self) -> None:
        self._findings: dict[tuple[str, str], CollectedFinding] = {}
        self._suggestions = Suggestions()

    def add(self, finding: CollectedFinding, name: str = "", known_names: Collection[str] = ()) -> None:
        """Add a problem; if it is about an unknown name, the most similar known one is suggested."""
        known = self._findings.get((finding.rule, finding.message))
        if known is not None:
            known.count += 1
            return
        if name:
            finding.help = self._suggestions.advice(name, known_names) + finding.help
        self._findings[finding.rule, finding.message] = finding

    def __iter__(self) -> Iterator[CollectedFinding]:
        return iter(self._findings.values())


def location(path: Path, source: SourceText, byte_offset: int, attribute: str = "") -> Location:
    """The location of a tag, given by its offset in bytes of UTF-8, or of one of its attributes."""
    offset = source.character_offset(byte_offset)
    line, column = source.position(source.attribute_offset(offset, attribute) if attribute else offset)
    return Location(path, line, column, source.line(line))


# Why a file cannot be read at all, as exceptions; the same words whatever the version of the model

#: Real models nest about 15 deep; far deeper, recursion over a model would fail with a less helpful message.
MAX_DEPTH = 200


def refusal(path: Path, file: FileText, offset: int, rule: str, message: str, help_text: str = "") -> ReadError:
    """The exception for a problem at an offset (in bytes of UTF-8) of a file that cannot be read because of it."""
    return ReadError([Finding(rule, Severity.ERROR, message, location(path, SourceText(file), offset), help_text)])


def has_doctype(path: Path, file: FileText, offset: int) -> ReadError:
    """The refusal of a document type declaration."""
    message = "the file has a document type declaration (DTD)"
    return refusal(path, file, offset, "XMI003", message, "Remove it; it is refused because it may define entities.")


def too_deep(path: Path, file: FileText, offset: int) -> ReadError:
    """The refusal of elements that are nested too deep."""
    message = f"the elements are nested more than {MAX_DEPTH} levels deep"
    help_text = "Check how the file was generated; no real model is nested that deep."
    return refusal(path, file, offset, "XMI004", message, help_text)


def malformed(
    path: Path, file: FileText, error: expat.ExpatError, offset: int, open_element: tuple[str, int] | None
) -> ReadError:
    """The refusal of text that is not well-formed.

    Parameters
    ----------
    open_element : what is not closed and the line of its start tag, None if everything is
    """
    if not file.text.lstrip().startswith("<"):
        return refusal(path, file, 0, "XMI002", "not XML", "AMALTHEA models are XML files in UTF-8, plain or zipped.")
    reason = expat.errors.messages[error.code]
    if open_element and reason == expat.errors.XML_ERROR_NO_ELEMENTS:
        name, line = open_element
        reason = f"unexpected end of file, the {name} on line {line} is not closed"
    return refusal(path, file, offset, "XMI002", f"not well-formed XML: {reason}")


def line_at(file: FileText, offset: int) -> int:
    """The line of an offset in bytes of UTF-8."""
    return file.utf8.count(b"\n", 0, offset) + 1


def lacks_namespace(utf8: bytes) -> bool:
    """Whether a text uses `xsi:type` without a declaration of the prefix; most texts need not be parsed to know it."""
    if b"xsi:type" not in utf8 or b"xmlns:xsi" in utf8:
        return False
    try:
        expat.ParserCreate("utf-8", " ").Parse(utf8, True)
    except expat.ExpatError as error:
        return expat.ErrorString(error.code) == expat.errors.XML_ERROR_UNBOUND_PREFIX
    return False  # only in a value or a comment


def undeclared_prefix(path: Path, file: FileText, offset: int, prefix: str, namespace: str) -> ReadError:
    """The refusal of a prefix without declaration."""
    message = f"not well-formed XML: undeclared namespace prefix {prefix!r}"
    return refusal(path, file, offset, "XMI002", message, f'Add xmlns:{prefix}="{namespace}" to the root element.')
