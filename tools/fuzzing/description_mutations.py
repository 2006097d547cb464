"""Mutations of descriptions: keys, values, structure."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

import yaml

from fuzzing import line_mutations
from fuzzing.hostile_values import VALUES

_COLLECTIONS = ("[]", "{}", "[a]", "{a: b}", "[[]]", "*a", "&a x", "!!str x", "{<<: 1}", "{x-note: 1}")


def _nodes(node: yaml.Node | None, is_key: bool = False) -> Iterator[tuple[int, int, bool]]:
    """Start and end of each node, and whether it is a key."""
    if node is None:
        return
    yield node.start_mark.index, node.end_mark.index, is_key
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            yield from _nodes(key, is_key=True)
            yield from _nodes(value)
    elif isinstance(node, yaml.SequenceNode):
        for item in node.value:
            yield from _nodes(item)


def _spans(text: str) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
    """The places of keys and of values; none if the text is not YAML."""
    try:
        found = list(_nodes(yaml.compose(text)))
    except yaml.YAMLError:
        found = []
    return [(a, b) for a, b, is_key in found if is_key], [(a, b) for a, b, is_key in found if not is_key]


def _replaced(text: str, span: tuple[int, int], new: str) -> str:
    old = text[slice(*span)]
    return text[: span[0]] + new + old[len(old.rstrip()) :] + text[span[1] :]


def change_value(rng: Random, text: str) -> str:
    """With another value."""
    _, values = _spans(text)
    return _replaced(text, rng.choice(values), rng.choice((*VALUES, *_COLLECTIONS))) if values else text


def swap_value(rng: Random, text: str) -> str:
    """With the value of another key."""
    _, values = _spans(text)
    return _replaced(text, rng.choice(values), text[slice(*rng.choice(values))].strip()) if values else text


def swap_key(rng: Random, text: str) -> str:
    """With another key of the file."""
    keys, _ = _spans(text)
    return _replaced(text, rng.choice(keys), text[slice(*rng.choice(keys))]) if keys else text


def misspell_key(rng: Random, text: str) -> str:
    """With a key that lacks a letter."""
    keys, _ = _spans(text)
    return _replaced(text, span, text[span[0] + 1 : span[1]]) if keys and (span := rng.choice(keys)) else text


MUTATIONS = (*(change_value,) * 4, *(swap_value,) * 3, swap_key, misspell_key, *line_mutations.MUTATIONS)
