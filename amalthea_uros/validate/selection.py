"""Selection of rules by profiles and patterns."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from fnmatch import fnmatchcase

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings import catalogue
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import RuleProfile


@dataclass(frozen=True, slots=True, kw_only=True)
class Selection:
    """Rules selected by profiles and ids.

    Attributes
    ----------
    profiles : the profiles to use; empty: all
    selected : ids of the rules to run; None: all rules of the profiles
    ignored : ids of the rules and other findings to leave out
    """

    profiles: tuple[RuleProfile, ...] = ()
    selected: frozenset[str] | None = None
    ignored: frozenset[str] = frozenset()

    def rules(self) -> list[str]:
        """The ids of the selected rules."""
        return [identifier for identifier in registry.ids(self.profiles or RuleProfile) if self._is_selected(identifier)]

    def _is_selected(self, identifier: str) -> bool:
        return identifier not in self.ignored and (self.selected is None or identifier in self.selected)


def select(profiles: Iterable[RuleProfile], selected: Iterable[str], ignored: Iterable[str]) -> Selection:
    """The selection of some profiles and patterns: an id, the first characters of ids, or a text in which `*` matches anything.

    Raises
    ------
    InvalidArgumentError : a pattern matches no rule, or, among the ignored ones, no finding either.
    """
    rules = list(registry.ids())
    asked, refused = tuple(selected), tuple(ignored)
    return Selection(
        profiles=tuple(profiles),
        selected=matching(asked, rules) if asked else None,
        ignored=matching(refused, [*rules, *catalogue.ids()]) if refused else frozenset(),
    )


def matching(patterns: Iterable[str], known: Collection[str]) -> frozenset[str]:
    """The ids that match one of some patterns.

    Raises
    ------
    InvalidArgumentError : a pattern matches none.
    """
    found: set[str] = set()
    for pattern in patterns:
        matches = _matches(pattern, known)
        if not matches:
            raise unknown_rule(pattern, [*known, *_beginnings(known)])
        found.update(matches)
    return frozenset(found)


def unknown_rule(name: str, known: Iterable[str]) -> InvalidArgumentError:
    """The error for the name of a rule, or the beginning of such names, that does not exist."""
    advice = did_you_mean(name, known) or "`amuros rules` lists all rules"
    return InvalidArgumentError(f"unknown rule {name!r}; {advice}")


def _matches(pattern: str, known: Collection[str]) -> list[str]:
    """The ids that a pattern means; an id itself is not the beginning of others: `TIM-PRIORITY` is not `TIM-PRIORITY-SHARED`."""
    if pattern in known:
        return [pattern]
    glob = pattern if "*" in pattern else f"{pattern}*"
    return [identifier for identifier in known if pattern and fnmatchcase(identifier, glob)]


def _beginnings(known: Iterable[str]) -> list[str]:
    """The first parts of ids: `INC` and `INC-HW` of `INC-HW-PU-CLOCK`, `UR` of `UR101`."""
    found: dict[str, None] = {}
    for identifier in known:
        parts = identifier.split("-")
        found.update(dict.fromkeys("-".join(parts[:count]) for count in range(1, len(parts))))
        found[identifier.rstrip("0123456789")] = None
    return list(found)
