"""The errors in sections as findings: what is wrong, where, and what to do; and what is left of a file without its mistakes."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import Any, NamedTuple

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.similar import similar
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.spec.nodes import MappingNode, Node, NodePlace, ScalarNode, SequenceNode, YamlText
from amalthea_uros.spec.schema_places import Schema, inner_schemas, nearest_places, schema_of, variants
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.spec.type_checks import ErrorDetails
from amalthea_uros.units import shortened

_WHOLE_NUMBER = re.compile(r"-?\d{1,30}", re.ASCII)
#: What is left of "1,5 ms" after a comma that separates the entries of {...}.
_AFTER_COMMA = re.compile(r"\d+ ?[^\W\d]+(/s)?")

#: As in difflib.
_SIMILAR = 0.6

#: What the field also calls a key.
_SYNONYMS = {
    "mean": ("avg",),
    "average": ("avg",),
    "acet": ("avg",),
    "bcet": ("min", "execution_time"),
    "wcet": ("max", "execution_time"),
    "frequency": ("rate",),
    "cycle_time": ("period",),
}


_LIST = "Write [a, b], or one item per line after '- '."
_MAPPING = "Write key: value pairs."
#: Types of errors -> message without what was found, and help.
_SENTENCES = {
    "unexpected": ("{message}", ""),
    "model_type": ("expected a mapping", _MAPPING),
    "model_attributes_type": ("expected a mapping", _MAPPING),
    "dict_type": ("expected a mapping", _MAPPING),
    "list_type": ("expected a list", _LIST),
    "greater_than_equal": ("must be at least {ge}", ""),
    "less_than_equal": ("must be at most {le}", ""),
    "greater_than": ("must be greater than {gt:g}", ""),
    "less_than": ("must be less than {lt:g}", ""),
    "int_type": ("expected a whole number", ""),
    "bool_type": ("{message}", ""),
    "string_type": ("expected a string", ""),
    "literal_error": ("expected {expected}", ""),
}


class Mistake(NamedTuple):
    """An error in the nodes of a file.

    Attributes
    ----------
    path : the nodes from the whole document to the erroneous one, or to the one that encloses it, if it is missing
    """

    details: ErrorDetails
    path: tuple[Node, ...]

    @classmethod
    def of(cls, details: ErrorDetails, node: Node) -> Mistake:
        """The error in a document."""
        return cls(details, tuple(_path(details["loc"], node)))

    @property
    def kind(self) -> str:
        """Type of the error."""
        return self.details["type"]

    @property
    def key(self) -> str:
        """The last part of the path to the error."""
        return str(self.details["loc"][-1]) if self.details["loc"] else ""


def finding_of(mistake: Mistake, source: YamlText, kind: type[DescriptionSection]) -> Finding:
    """The finding for an error in a section of some kind."""
    value = mistake.path[-1]
    match mistake.kind:
        case "extra_forbidden":
            message = f"unknown key {shortened(mistake.key)!r}"
            return Finding("YML010", Severity.ERROR, message, source.location(_key_place(mistake)), _advice(mistake, kind))
        case "missing":
            return Finding("YML011", Severity.ERROR, f"missing key {mistake.key!r}", source.location(value.place))
    message, help_text = _sentence(mistake.details, value)
    return Finding("YML012", Severity.ERROR, f"{_owner(mistake)}{message}", source.location(value.place), help_text)


#: A key with more places than this says little.
_MOST_PLACES = 3


def intended_key(mistake: Mistake, kind: type[DescriptionSection], similarity: float = _SIMILAR) -> str | None:
    """The key that an unknown key is probably a misspelling of."""
    known, key = _keys(mistake.details["loc"][:-1], kind), mistake.key.replace("-", "_")
    synonym = next((each for each in _SYNONYMS.get(key.lower(), ()) if each in known), None)
    return synonym or next(iter(similar(key, known, cutoff=similarity)), None)


def intended_word(mistake: Mistake, similarity: float = _SIMILAR) -> str | None:
    """The allowed word that a wrong word is probably a misspelling of."""
    given = mistake.details["input"]
    if not isinstance(given, str):
        return None
    expected = str(mistake.details["ctx"]["expected"]).replace(" or ", ", ").split(", ")
    return next(iter(similar(given, [word.strip("'") for word in expected], cutoff=similarity)), None)


def without_consequences(mistakes: list[Mistake]) -> list[Mistake]:
    """The mistakes without those in the number before a decimal comma, of which the rest is an unknown key."""
    rests = [mistake for mistake in mistakes if mistake.kind == "extra_forbidden" and _AFTER_COMMA.fullmatch(mistake.key)]
    holders = {id(holder): holder for holder in (mistake.path[-2] for mistake in rests) if isinstance(holder, MappingNode)}
    cut_off = _before({id(mistake.path[-1]) for mistake in rests}, holders.values())
    return [mistake for mistake in mistakes if id(mistake.path[-1]) not in cut_off]


def _before(nodes: set[int], holders: Iterable[MappingNode]) -> set[int]:
    """The values before some others in mappings, all by their ids: nodes that look the same are different ones."""
    return {id(value) for holder in holders for value, following in pairwise(holder.items.values()) if id(following) in nodes}


def _path(loc: tuple[int | str, ...], node: Node) -> Iterator[Node]:
    """The nodes on the path to an error; parts that are no nodes are skipped."""
    yield node
    for part in loc:
        if isinstance(node, MappingNode) and part in node.items:
            node = node.items[str(part)]
            yield node
        elif isinstance(node, SequenceNode) and isinstance(part, int) and part < len(node.items):
            node = node.items[part]
            yield node


def _key_place(mistake: Mistake) -> NodePlace:
    *_, holder, value = mistake.path
    return holder.keys[mistake.key] if isinstance(holder, MappingNode) else value.place


def _owner(mistake: Mistake) -> str:
    """The key that the erroneous value belongs to, as the start of a sentence."""
    for part in reversed(mistake.details["loc"]):
        if any(isinstance(node, MappingNode) and part in node.items for node in mistake.path):
            return f"{shortened(str(part))}: "
    return ""


def _sentence(details: ErrorDetails, node: Node) -> tuple[str, str]:
    """Message and help of an error."""
    context: dict[str, Any] = details.get("ctx", {})
    match details["type"]:
        case "empty":
            return "no value is given", "Give a value, or remove the key."
        case "too_short":
            return f"expected at least {counted(context['min_length'], 'item')}, found {context['actual_length']}", ""
        case "too_long":
            return f"expected at most {counted(context['max_length'], 'item')}, found {context['actual_length']}", ""
    template, help_text = _SENTENCES.get(details["type"], ("", ""))
    if not template:
        return details["msg"], ""
    return f"{template.format(message=details['msg'], **context)}, found {_given(node)}", help_text or _correction(
        details, node
    )


def _given(node: Node) -> str:
    """What the author wrote, for a message."""
    match node:
        case MappingNode():
            return "a mapping"
        case SequenceNode():
            return "a list"
        case ScalarNode(value=None):
            return "nothing"
        case ScalarNode(value=bool() as value):
            return str(value).lower()
        case ScalarNode(value=value):
            return shortened(repr(value))


def _correction(details: ErrorDetails, node: Node) -> str:
    """What was probably meant instead of a wrong value."""
    if details["type"] == "literal_error":
        word = intended_word(Mistake(details, (node,)))
        return f"Did you mean {word!r}?" if word else ""
    wants_number = "number" in details["msg"] or "integer" in details["msg"]
    if wants_number and isinstance(node, ScalarNode) and isinstance(node.value, str) and _WHOLE_NUMBER.fullmatch(node.value):
        return f"Write {int(node.value)}, without quotes, sign or leading zeros." if node.value else ""
    return ""


def _advice(mistake: Mistake, kind: type[DescriptionSection]) -> str:
    """The help line for an unknown key."""
    if _AFTER_COMMA.fullmatch(mistake.key):
        return "A comma separates keys; write decimals with a point, e.g. 1.5 ms."
    if certain := intended_key(mistake, kind, CERTAIN):
        return f"Did you mean {certain!r}?"
    elsewhere = nearest_places(mistake.key, mistake.details["loc"][:-1], kind)
    if 0 < len(elsewhere) <= _MOST_PLACES:
        places = " or ".join(f"'{'.'.join(place)}'" if place else "the top level" for place in elsewhere)
        return f"{mistake.key!r} belongs in {places}."
    if intended := intended_key(mistake, kind):
        return f"Did you mean {intended!r}?"
    known = _keys(mistake.details["loc"][:-1], kind)
    return f"Known keys: {', '.join(known)}." if known else ""


def _keys(loc: tuple[int | str, ...], kind: type[DescriptionSection]) -> list[str]:
    """The keys that the JSON schema allows at a place."""
    whole = schema_of(kind)
    level: list[Schema] = [whole]
    for part in loc:
        level = [inner for one in level for inner in inner_schemas(one, part, whole)] or level
    return [key for one in level for variant in variants(one, whole) for key in variant.get("properties", ())]


#: Similarity of words from which on one is taken for a misspelling of the other.
CERTAIN = 0.8


def repair(mistakes: Iterable[Mistake], kind: type[DescriptionSection]) -> set[NodePlace] | None:
    """Correct misspelled keys and words in the nodes of a file, and remove those that are not understood.

    Returns
    -------
    set : the places whose further findings may be consequences; None if a mistake leaves too little to examine, such as an unknown
        list, which may define names.
    """
    touched: set[NodePlace] = set()
    for mistake in mistakes:
        holder = mistake.path[-2] if len(mistake.path) > 1 else None
        if not isinstance(holder, MappingNode) or not _repair(mistake, holder, kind):
            return None
        touched.update(_places(holder))
    return touched


def _repair(mistake: Mistake, holder: MappingNode, kind: type[DescriptionSection]) -> bool:
    """Repair a mistake in the mapping that it is in, unless that would be a guess."""
    value = mistake.path[-1]
    key = next((part for part in map(str, reversed(mistake.details["loc"])) if holder.items.get(part) is value), None)
    if key is None:
        return True  # It is also in the place of an alias, where it was repaired.
    if mistake.kind == "extra_forbidden":
        return _rename(holder, key, intended_key(mistake, kind, CERTAIN))
    if mistake.kind == "literal_error":
        word = intended_word(mistake, CERTAIN)
        if word is None:
            del holder.items[key]
        else:
            holder.items[key] = ScalarNode(value.place, word)
        return True
    return False


def _rename(holder: MappingNode, key: str, intended: str | None) -> bool:
    if intended is not None and intended not in holder.items:
        holder.items[intended], holder.keys[intended] = holder.items[key], holder.keys[key]
    elif not isinstance(holder.items[key], ScalarNode):
        return False
    del holder.items[key]
    return True


def _places(holder: MappingNode) -> Iterator[NodePlace]:
    """The places of a mapping and of its plain values."""
    yield holder.place
    for item in holder.items.values():
        if isinstance(item, ScalarNode):
            yield item.place
