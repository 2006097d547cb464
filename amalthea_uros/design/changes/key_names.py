"""Names of keys: some of the names on the way to a value, the last one among them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Protocol, TypeVar

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import listed


class NamedKey(Protocol):
    """A value with names on the way to it."""

    @property
    def path(self) -> Sequence[str | int]:
        """The way to the value, with the numbers of objects in place of their names."""
        ...

    @property
    def names(self) -> Sequence[str]:
        """The names on the way, the last one that of the value."""
        ...


K = TypeVar("K", bound=NamedKey)


def with_gaps(target: str, keys: Iterable[K]) -> list[tuple[int, K]]:
    """The keys that are meant by some of their names, with the number of names left out; those in the same case, if there are any."""
    every, end = list(keys), target.rpartition(".")[2]
    # Most keys end otherwise; a name can have dots itself.
    matches = [(gap, key) for key in every if key.names[-1].endswith(end) and (gap := _gap(target, key.names)) is not None]
    if matches:
        return matches
    folded = target.casefold()
    return [(gap, key) for key in every if (gap := _gap(folded, [each.casefold() for each in key.names])) is not None]


def only_one(target: str, matches: Sequence[K], what: str, names: Callable[[Sequence[K]], Sequence[str]]) -> K | None:
    """The only key that a name means, None if there is none.

    Parameters
    ----------
    what : has the keys
    names : the shortest names of keys

    Raises
    ------
    InvalidArgumentError : the name means several keys.
    """
    if len(matches) > 1:
        raise InvalidArgumentError(f"{target!r} means several values of the {what}: {listed(names(matches))}; choose one")
    return matches[0] if matches else None


def _gap(target: str, names: Sequence[str]) -> int | None:
    """How many names are left out between those of a target; None if the target is no part of the names."""
    rest = _without(target, names[-1])
    if rest is None:
        return None
    gap = between = 0
    for name in reversed(names[:-1]):
        if not rest:
            break
        shorter = _without(rest, name)
        if shorter is None:
            between += 1
        else:
            rest, gap = shorter, gap + between
            between = 0
    return None if rest else gap


def _without(target: str, name: str) -> str | None:
    """A target without its last name, None if that is another one."""
    if target == name:
        return ""
    return target.removesuffix(f".{name}") if target.endswith(f".{name}") else None


def shorter_names(key: NamedKey) -> Iterator[str]:
    """Names that may mean only this key, the better ones first: those with the object that has it."""
    names = key.names
    objects = [index for index, name in enumerate(names[:-1]) if name not in key.path[:-1]]
    for length in range(1, len(names)):
        end = names[-length:]
        yield from (".".join((names[index], *end)) for index in reversed(objects) if index < len(names) - length)
        if len(end) > 1 or len(names) == 1:
            yield ".".join(end)
