"""Mutations of texts that consist of words and brackets: sources, build options, databases."""

from __future__ import annotations

import re
from random import Random

from fuzzing import line_mutations
from fuzzing.hostile_values import VALUES

_WORD = re.compile(r"[A-Za-z_]\w*|\d+(?:\.\d+)?|\"[^\"\n]*\"")
_MARK = re.compile(r"[][(){};,:#&*/\"=|@]")
_NESTED = ("((((", "{{{{", "[[[[", "/*", "*/", "//", "#define X X\n", "#if 1\n", "#endif\n", '"', "'", "\\\n", 'R"x(')


def _replaced(rng: Random, text: str, pattern: re.Pattern[str], new: str) -> str:
    places = [match.span() for match in pattern.finditer(text)]
    if not places:
        return text
    start, end = rng.choice(places)
    return text[:start] + new + text[end:]


def swap_word(rng: Random, text: str) -> str:
    """With another word of the text."""
    words = _WORD.findall(text)
    return _replaced(rng, text, _WORD, rng.choice(words)) if words else text


def change_word(rng: Random, text: str) -> str:
    """With a value that nobody expects."""
    return _replaced(rng, text, _WORD, rng.choice(VALUES))


def drop_mark(rng: Random, text: str) -> str:
    """Without a bracket, or another mark."""
    return _replaced(rng, text, _MARK, "")


def insert_mark(rng: Random, text: str) -> str:
    """With what opens, or ends, something."""
    return _replaced(rng, text, _MARK, rng.choice(_NESTED) * rng.choice((1, 1, 200)))


MUTATIONS = (*(swap_word,) * 4, *(change_word,) * 3, drop_mark, insert_mark, *line_mutations.MUTATIONS)
