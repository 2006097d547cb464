"""Changes of a system, applied and described."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import reduce
from typing import Any

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.similar import similar
from amalthea_uros.design.changes.change import EXAMPLE, FORM, Change
from amalthea_uros.design.changes.key import UNSET, Configuration, Key
from amalthea_uros.design.changes.kinds import CORE, FIRST_KEYS, KINDS
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings


@dataclass(frozen=True, slots=True)
class Difference:
    """What a change does: the values before and after, as text.

    Attributes
    ----------
    is_consequence : whether the value is not the one that was set
    """

    object: str
    key: str
    before: str
    after: str
    is_consequence: bool = False

    @property
    def target(self) -> str:
        """The object and the key, such as "Executor_Task.period"."""
        return f"{self.object}.{self.key}".removeprefix(".")

    def __str__(self) -> str:
        return f"{self.target}: {self.before} -> {self.after}" + (" (consequence)" if self.is_consequence else "")


def apply(system: System, settings: Settings, changes: Iterable[Change]) -> Configuration:
    """The system and the settings with changes.

    A stimulus that several processes share is copied when it is changed for one of them. Times are converted to ticks at the
    frequencies after all changes. Later changes of the same value count.

    Raises
    ------
    InvalidArgumentError : an object or a key does not exist, a value is wrong, or the object has no place for it.
    """
    return reduce(_changed, sorted(changes, key=_order), Configuration(system, settings))


def describe(system: System, settings: Settings, changes: Sequence[Change]) -> tuple[Difference, ...]:
    """The values before and after changes; raises as `apply`."""
    before, after = Configuration(system, settings), apply(system, settings, changes)
    targets = dict.fromkeys((change.object, change.key) for change in changes)
    return tuple(Difference(name, key, _shown(before, name, key), _shown(after, name, key)) for name, key in targets)


def check_key(system: System, name: str, key: str) -> None:
    """Refuse a property that an object does not have; raises InvalidArgumentError."""
    _keys(system, name, key)


def _order(change: Change) -> int:
    return FIRST_KEYS.index(change.key) if change.key in FIRST_KEYS else len(FIRST_KEYS)


def _changed(configuration: Configuration, change: Change) -> Configuration:
    errors, keys = [], list(_keys(configuration.system, change.object, change.key))
    if len(keys) > 1:
        # Of several objects with the name, one that states a value is meant.
        keys.sort(key=lambda each: each.show(configuration, change.object) == UNSET)
    for key in keys:
        try:
            return key.set(configuration, change.object, key.parse(change.value))
        except ValueError as error:
            errors.append(error)
    raise InvalidArgumentError(f"{change}: {errors[0]}") from None


def _shown(configuration: Configuration, name: str, key: str) -> str:
    texts = [each.show(configuration, name) for each in _keys(configuration.system, name, key)]
    return next((text for text in texts if text != UNSET), UNSET)


def _keys(system: System, name: str, key: str) -> Iterator[Key[Any]]:
    """The key of each kind of object that has the name, the kinds in their order."""
    if not name:
        raise InvalidArgumentError(f"{key!r} does not name an object and a key; expected {FORM}, e.g. {EXAMPLE}")
    kinds = [kind for kind in KINDS if name in kind.objects(system)]
    if not kinds and not system.cores and key in CORE.keys:
        kinds = [CORE]
    if not kinds:
        require("object", [name], dict.fromkeys(each for kind in KINDS for each in kind.objects(system)))
    found = [kind.keys[key] for kind in kinds if key in kind.keys]
    if not found:
        existing = list(dict.fromkeys(each for kind in kinds for each in kind.keys))
        near = similar(key, existing)
        advice = f"did you mean {near[0]!r}?" if near else f"it has {', '.join(existing)}"
        raise InvalidArgumentError(f"the {' or '.join(kind.name for kind in kinds)} {name!r} has no {key!r}; {advice}")
    return iter(found)
