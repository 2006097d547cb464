"""Mutations of any text by its lines."""

from __future__ import annotations

from random import Random


def _range(rng: Random, lines: list[str]) -> tuple[int, int]:
    start = rng.randrange(len(lines))
    return start, min(len(lines), start + rng.choice((1, 1, 1, 2, 5, 20)))


def delete(rng: Random, text: str) -> str:
    """Without some lines."""
    lines = text.splitlines(keepends=True)
    start, end = _range(rng, lines)
    return "".join(lines[:start] + lines[end:])


def repeat(rng: Random, text: str) -> str:
    """With some lines twice."""
    lines = text.splitlines(keepends=True)
    start, end = _range(rng, lines)
    return "".join(lines[:end] + lines[start:])


def move(rng: Random, text: str) -> str:
    """With some lines at another place."""
    lines = text.splitlines(keepends=True)
    start, end = _range(rng, lines)
    moved, rest = lines[start:end], lines[:start] + lines[end:]
    target = rng.randint(0, len(rest))
    return "".join(rest[:target] + moved + rest[target:])


def cut(rng: Random, text: str) -> str:
    """Only the beginning, as after an interrupted transfer."""
    return text[: rng.randrange(len(text))]


def insert(rng: Random, text: str) -> str:
    """With characters that belong nowhere."""
    at = rng.randint(0, len(text))
    return (
        text[:at] + rng.choice(("\t", "\r", "\0", "\x1b", "\ufeff", "\u2028", "<", "&", '"', "{", ": ", "- ", "\n")) + text[at:]
    )


MUTATIONS = (delete, repeat, move, delete, repeat, move, cut, insert)
