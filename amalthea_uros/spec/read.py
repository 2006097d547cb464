"""`app.yaml` -> description, with all errors of the file in one run."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from amalthea_uros._internal.files import FileError, FileTooLargeError, read_text
from amalthea_uros._internal.limits import DESCRIPTION_SIZE
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.nodes import MAX_FINDINGS, Mapping, Node, Place, Scalar, Sequence, Source, plain, read_nodes
from amalthea_uros.spec.section import Section, attach_locations
from amalthea_uros.units import shortened

S = TypeVar("S", bound=Section)


def read_description(path: Path) -> Description:
    """The description in a file.

    Raises
    ------
    ReadError : the file cannot be read, or something in it is wrong; carries a finding for each error.
    """
    return read_section(path, Description)


def read_section(path: Path, kind: type[S]) -> S:
    """A file as a section of some kind; raises as `read_description`."""
    node, source, findings = read_nodes(path, _text(path))
    if isinstance(node, Scalar) and node.value is None:
        raise ReadError([*findings, Finding("YML001", Severity.ERROR, "the file is empty", Location(path))])
    section = None
    try:
        section = kind.model_validate(plain(node))
    except ValidationError as error:
        findings += [_finding(details, node, source, kind) for details in error.errors(include_url=False)]
    if section is None or findings:
        raise ReadError(_in_order(findings))
    attach_locations(section, node, source)
    return section


def _text(path: Path) -> str:
    try:
        return read_text(path, DESCRIPTION_SIZE)
    except FileTooLargeError as error:
        raise ReadError([Finding("YML002", Severity.ERROR, error.reason, Location(path), error.advice)]) from None
    except FileError as error:
        raise ReadError([Finding("YML001", Severity.ERROR, error.reason, Location(path), error.advice)]) from None


def _in_order(findings: list[Finding]) -> list[Finding]:
    """The findings from top to bottom, each once, up to the limit."""

    def position(finding: Finding) -> tuple[int, int]:
        place = finding.location
        return ((place.line or 0, place.column or 0)) if place else (0, 0)

    return sorted(dict.fromkeys(findings), key=position)[:MAX_FINDINGS]


def _finding(details: ErrorDetails, node: Node, source: Source, kind: type[Section]) -> Finding:
    """The finding for an error of pydantic."""
    places = list(_places(details["loc"], node))
    place, value = places[-1]
    if details["type"] == "extra_forbidden":
        holder = places[-2][1]
        if isinstance(holder, Mapping):
            place = holder.keys[str(details["loc"][-1])]
        key = str(details["loc"][-1])
        message = f"unknown key {shortened(key)!r}"
        return Finding(
            "YML010", Severity.ERROR, message, source.location(place), _advice(key, _keys(details["loc"][:-1], kind))
        )
    if details["type"] == "missing":
        message = f"missing key {details['loc'][-1]!r}"
        return Finding("YML011", Severity.ERROR, message, source.location(place), "")
    key = next((f"{part}: " for part in reversed(details["loc"]) if isinstance(part, str) and _is_key(part, node, places)), "")
    message, help_text = _sentence(details, value)
    return Finding("YML012", Severity.ERROR, f"{key}{message}", source.location(place), help_text)


def _is_key(part: str, node: Node, places: list[tuple[Place, Node]]) -> bool:
    return any(isinstance(holder, Mapping) and part in holder.items for holder in (node, *(value for _, value in places)))


def _places(loc: tuple[int | str, ...], node: Node) -> Iterator[tuple[Place, Node]]:
    """The nodes on the path to an error, each with its place; parts that exist only in pydantic are skipped."""
    yield node.place, node
    for part in loc:
        if isinstance(node, Mapping) and part in node.items:
            node = node.items[str(part)]
            yield node.place, node
        elif isinstance(node, Sequence) and isinstance(part, int) and part < len(node.items):
            node = node.items[part]
            yield node.place, node


def _sentence(details: ErrorDetails, node: Node) -> tuple[str, str]:
    """Message and help of an error."""
    context: dict[str, Any] = details.get("ctx", {})
    given = shortened(repr(node.value)) if isinstance(node, Scalar) else {Mapping: "a mapping", Sequence: "a list"}[type(node)]
    match details["type"]:
        case "literal_error":
            allowed = [word.strip("'") for word in str(context["expected"]).replace(" or ", ", ").split(", ")]
            return f"expected {context['expected']}, found {given}", _near(str(details["input"]), allowed)
        case "model_type" | "model_attributes_type" | "dict_type":
            return f"expected a mapping, found {given}", "Write key: value pairs."
        case "list_type":
            return f"expected a list, found {given}", "Write [a, b], or one item per line after '- '."
        case "too_short":
            return f"expected at least {context['min_length']}, found {context['actual_length']}", ""
        case "too_long":
            return f"expected at most {context['max_length']}, found {context['actual_length']}", ""
        case "greater_than_equal":
            return f"must be at least {context['ge']}, found {given}", ""
        case "less_than_equal":
            return f"must be at most {context['le']}, found {given}", ""
        case "greater_than":
            return f"must be greater than {context['gt']:g}, found {given}", ""
        case "less_than":
            return f"must be less than {context['lt']:g}, found {given}", ""
        case "int_type" | "int_parsing" | "int_from_float":
            return f"expected a whole number, found {given}", ""
        case "float_type" | "float_parsing" | "finite_number":
            return f"expected a number, found {given}", ""
        case "string_type":
            return f"expected a string, found {given}", ""
    return details["msg"], ""


def _near(word: str, words: list[str]) -> str:
    near = get_close_matches(word, words, n=1)
    return f"Did you mean {near[0]!r}?" if near else ""


def _advice(key: str, known: list[str]) -> str:
    folded = {name.lower(): name for name in known}
    near = get_close_matches(key.replace("-", "_").lower(), folded, n=1)
    if near:
        return f"Did you mean {folded[near[0]]!r}?"
    return f"Known keys: {', '.join(known)}." if known else ""


def _keys(loc: tuple[int | str, ...], kind: type[Section]) -> list[str]:
    """The keys that the JSON schema allows at a place."""
    schema = _schema(kind)
    level = [schema]
    for part in loc:
        found = [inner for one in level for inner in _inner(one, part, schema)]
        level = found or level
    return [key for one in level for variant in _variants(one, schema) for key in variant.get("properties", ())]


@cache
def _schema(kind: type[Section]) -> dict[str, Any]:
    return kind.model_json_schema(by_alias=True)


def _variants(schema: dict[str, Any], whole: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """A schema and its alternatives."""
    if "$ref" in schema:
        yield from _variants(whole["$defs"][schema["$ref"].rpartition("/")[2]], whole)
        return
    yield schema
    for inner in schema.get("anyOf", ()):
        yield from _variants(inner, whole)


def _inner(schema: dict[str, Any], part: int | str, whole: dict[str, Any]) -> Iterator[dict[str, Any]]:
    for variant in _variants(schema, whole):
        if isinstance(part, int):
            yield from filter(None, [variant.get("items")])
        else:
            inner = variant.get("properties", {}).get(part)
            extra = variant.get("additionalProperties")
            yield from filter(None, [inner or (extra if isinstance(extra, dict) else None)])
