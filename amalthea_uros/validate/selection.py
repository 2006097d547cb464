"""Selection of rules by profiles and patterns."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fnmatch import fnmatchcase

from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import Profile


@dataclass(frozen=True, slots=True, kw_only=True)
class Selection:
    """Rules selected by profiles and by patterns in which `*` matches any text.

    Attributes
    ----------
    profiles : the profiles to use; empty: all
    selected : patterns of the rules to run; empty: all rules of the profiles
    ignored : patterns of the rules and other findings to leave out
    """

    profiles: tuple[Profile, ...] = ()
    selected: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()

    def rules(self) -> list[str]:
        """The ids of the selected rules."""
        known = registry.ids(self.profiles or Profile)
        return [identifier for identifier in known if self._is_selected(identifier) and not self.is_ignored(identifier)]

    def unknown(self) -> list[str]:
        """The patterns in `selected` that match no rule."""
        known = list(registry.ids())
        return [pattern for pattern in self.selected if not any(fnmatchcase(identifier, pattern) for identifier in known)]

    def is_ignored(self, identifier: str) -> bool:
        """Whether findings with an id are left out."""
        return _matches(identifier, self.ignored)

    def _is_selected(self, identifier: str) -> bool:
        return not self.selected or _matches(identifier, self.selected)


def _matches(identifier: str, patterns: Iterable[str]) -> bool:
    return any(fnmatchcase(identifier, pattern) for pattern in patterns)
