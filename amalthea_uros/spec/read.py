"""`app.yaml` -> description, with all errors of the file in one run; also `TODO` in place of a value, as `amuros import` writes it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Generic, TypeVar

from amalthea_uros._internal.files import FileError, FileFlaw, read_text
from amalthea_uros._internal.limits import DESCRIPTION_SIZE
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.content import nodes_of
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.mistakes import Mistake, finding_of, repair, without_consequences
from amalthea_uros.spec.nodes import MAX_FINDINGS, MappingNode, Node, ScalarNode, SequenceNode, YamlText, plain, read_nodes
from amalthea_uros.spec.section import EXTENSION, DescriptionSection, attach_locations
from amalthea_uros.spec.type_checks import WRONG, Errors

GAP = "TODO"
#: What to write for the keys that source code does not tell.
_ADVICE = {
    "execution_time": "Measure it, or write bounds such as {min: 10 us, max: 60 us}.",
    "base": "Measure an iteration without messages, or write bounds such as {min: 10 us, max: 60 us}.",
    "per_message": "Measure how long it takes to take a message, e.g. 30 us.",
    "rate": "Write how often messages arrive at most, e.g. 20 Hz.",
    "message_size": "Write the longest message, e.g. 64 B.",
    "string": "Write the number of characters of the longest string in a message, e.g. 20.",
    "sequence": "Write the number of elements of the longest sequence in a message, e.g. 6.",
    "frequency": "Write the clock of the controller, e.g. 160 MHz.",
    "bitrate": "Write the bit rate of the link, e.g. 20 Mbit/s.",
    "baud_rate": "Write the rate of the line, as the agent has it, e.g. 115200.",
    "transport": "Write the transport to the agent, e.g. {serial: {baud_rate: 115200}}.",
    "sleep": "Write how long the thread sleeps in its loop, e.g. 10 ms.",
    "trigger": "Write the sets of callbacks that it waits for, e.g. {custom: [[A, B], [C]]}.",
}


def is_gap(node: Node) -> bool:
    """Whether a value is to be filled in."""
    return isinstance(node, ScalarNode) and node.value == GAP


def gaps(node: Node, source: YamlText) -> Iterator[Finding]:
    """A finding for each value that is to be filled in; also for names, which `TODO` could be."""
    for key, value in _values(node, ""):
        if is_gap(value):
            what = f"{key!r} has no value yet (TODO)" if key else "a value is still to be filled in (TODO)"
            advice = _ADVICE.get(key, "Replace TODO by a value.")
            yield Finding("IMP001", Severity.ERROR, what, source.location(value.place), advice)


def _values(node: Node, key: str) -> Iterator[tuple[str, Node]]:
    match node:
        case MappingNode():
            for name, item in node.items.items():
                if not name.startswith(EXTENSION):
                    yield from _values(item, name)
        case SequenceNode():
            for item in node.items:
                yield from _values(item, key)
        case _:
            yield key, node


S = TypeVar("S", bound=DescriptionSection)


def read_description(path: Path) -> Description:
    """The description in a file.

    Raises
    ------
    ReadError : the file cannot be read, or something in it is wrong; carries a finding for each error.
    """
    return read_section(path, Description)


def read_section(path: Path, kind: type[S]) -> S:
    """A file as a section of some kind; raises as `read_description`."""
    draft: Draft[S] = _known_draft(path, description_text(path), kind)
    if draft.section is None or draft.findings:
        raise ReadError(draft.findings)
    return draft.section


@lru_cache(maxsize=8)
def _known_draft(path: Path, text: str, kind: type[Any]) -> Draft[Any]:
    """A draft; that of a platform is asked for again by each change of a description."""
    return text_draft(path, text, kind)


@dataclass(frozen=True, slots=True)
class Draft(Generic[S]):
    """A file as far as it can be understood.

    Attributes
    ----------
    section : without what is wrong in it; None if what is left says too little
    findings : what is wrong
    doubtful : places about which nothing more can be said, because of what is wrong there
    """

    section: S | None
    findings: tuple[Finding, ...]
    doubtful: frozenset[Location] = frozenset()

    def with_more(self, findings: Iterable[Finding]) -> tuple[Finding, ...]:
        """The findings together with those about the rest, without the consequences of what is wrong."""
        more = [finding for finding in findings if finding.location not in self.doubtful]
        return _in_order([*self.findings, *more])


def text_draft(path: Path, text: str, kind: type[S]) -> Draft[S]:
    """A text as a section of some kind, as the content of a file with this path, with all that is wrong in it.

    Raises
    ------
    ReadError : it cannot be read at all.
    """
    _refuse_xml(path, text)
    node, source, findings = read_nodes(path, text)
    if isinstance(node, ScalarNode) and node.value is None:
        raise ReadError([*findings, Finding("YML001", Severity.ERROR, "the file is empty", Location(path))])
    return _draft(node, source, findings, kind)


def content_draft(content: Mapping[Any, Any], kind: type[S]) -> Draft[S]:
    """The content of a file as a section of some kind; the findings have the paths of keys instead of lines.

    Raises
    ------
    ReadError : the content exceeds a limit, or holds something that YAML cannot.
    """
    node, source = nodes_of(content)
    return _draft(node, source, [], kind)


def _draft(node: Node, source: YamlText, findings: list[Finding], kind: type[S]) -> Draft[S]:
    findings += gaps(node, source)
    section, mistakes = _validated(node, kind)
    if section is not None:
        attach_locations(section, node, source)
        return Draft(section, _in_order(findings))
    findings += [finding_of(mistake, source, kind) for mistake in mistakes if not is_gap(mistake.path[-1])]
    touched = repair(mistakes, kind)
    if touched is None:
        return Draft(None, _in_order(findings))
    doubtful = frozenset(map(source.location, touched))
    section, mistakes = _validated(node, kind)
    rest = Draft(section, _in_order(findings), doubtful)
    if section is not None:
        attach_locations(section, node, source)
        return rest
    return Draft(
        None, rest.with_more(finding_of(mistake, source, kind) for mistake in mistakes if not is_gap(mistake.path[-1]))
    )


def _validated(node: Node, kind: type[S]) -> tuple[S | None, list[Mistake]]:
    errors: Errors = []
    section = kind.checked(plain(node), (), errors)
    if section is not WRONG:
        return section, []
    return None, without_consequences([Mistake.of(details, node) for details in errors])


def _refuse_xml(path: Path, text: str) -> None:
    """Say that a model is not a description, before XML is reported as YAML with errors."""
    if text.lstrip("\ufeff \t\r\n").startswith(("<?", "<!", "<am:", "<xmi:")):
        is_model = path.suffix.lower().startswith(".amxmi") or "amalthea" in text[:5000].lower()
        what = "this is an AMALTHEA model" if is_model else "this is XML"
        advice = "Give an app.yaml here; models can be given to amuros check, analyze and simulate." if is_model else ""
        raise ReadError([Finding("YML001", Severity.ERROR, f"{what}, not YAML", Location(path, 1, 1), advice)])


def description_text(path: Path) -> str:
    """The text of a file; ReadError if it cannot be read."""
    try:
        return read_text(path, DESCRIPTION_SIZE)
    except FileError as error:
        rule = "YML002" if error.flaw is FileFlaw.SIZE else "YML001"
        raise ReadError([Finding(rule, Severity.ERROR, error.reason, Location(path), error.advice)]) from None


def _in_order(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """The findings from top to bottom, each once, up to the limit."""

    def position(finding: Finding) -> tuple[int, int]:
        place = finding.location
        return ((place.line or 0, place.column or 0)) if place else (0, 0)

    return tuple(sorted(dict.fromkeys(findings), key=position)[:MAX_FINDINGS])
