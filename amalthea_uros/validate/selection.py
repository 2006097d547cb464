"""Which rules somebody wants."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fnmatch import fnmatchcase

from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import Profile


@dataclass(frozen=True, slots=True, kw_only=True)
class Selection:
    """Which rules are wanted, by patterns in which `*` stands for anything.

    Attributes
    ----------
    profiles : rules for these purposes; all if none is given
    selected : only these rules; all of the profiles if none is given
    ignored : not these rules, nor other findings of that id
    """

    profiles: tuple[Profile, ...] = ()
    selected: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()

    def rules(self) -> list[str]:
        """The ids of the rules that are wanted."""
        known = registry.ids(self.profiles or Profile)
        return [identifier for identifier in known if self._is_selected(identifier) and not self.is_ignored(identifier)]

    def unknown(self) -> list[str]:
        """The patterns to select that no rule has."""
        known = list(registry.ids())
        return [pattern for pattern in self.selected if not any(fnmatchcase(identifier, pattern) for identifier in known)]

    def is_ignored(self, identifier: str) -> bool:
        """Whether findings of an id are not wanted."""
        return _matches(identifier, self.ignored)

    def _is_selected(self, identifier: str) -> bool:
        return not self.selected or _matches(identifier, self.selected)


def _matches(identifier: str, patterns: Iterable[str]) -> bool:
    return any(fnmatchcase(identifier, pattern) for pattern in patterns)
