"""Names of objects that a recorder knows by numbers or addresses: names may be missing, and several objects may have the same one."""

from __future__ import annotations

from collections.abc import Hashable


class UniqueNames:
    """Gives each object a name of its own.

    The first one with a name keeps it; the identification of the others is added in brackets.
    """

    def __init__(self) -> None:
        self._names: dict[Hashable, str] = {}
        self._owners: dict[str, Hashable] = {}

    def name(self, key: Hashable, name: str, identification: str, missing: str) -> str:
        """The name of an object, which stays the same.

        Parameters
        ----------
        key : what identifies the object
        name : what the recorder calls it, maybe nothing
        identification : the key as text
        missing : what kind of object it is, for its name if it has none
        """
        known = self._names.get(key)
        if known is None:
            wanted = name.strip() or f"{missing} {identification}"
            known = wanted if wanted not in self._owners else f"{wanted} ({identification})"
            number = 2
            while known in self._owners:
                known, number = f"{wanted} ({identification}, {number})", number + 1
            self._names[key] = known
            self._owners[known] = key
        return known
