"""Settings of a project: `[tool.amuros.check]` in `pyproject.toml`, or `[check]` in `amuros.toml`."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.findings.targets import TARGETS
from amalthea_uros.validate.rule import Profile

#: Where settings may stand, and under which tables of the file; the first one that has them counts.
_PLACES = (("amuros.toml", ("check",)), ("pyproject.toml", ("tool", "amuros", "check")))


@dataclass(frozen=True, slots=True, kw_only=True)
class Configuration:
    """What a project wants of `amuros check`; see its options.

    Attributes
    ----------
    targets : the tools for which the models are written
    baseline : relative to the folder of the file
    """

    profile: tuple[str, ...] = ()
    targets: tuple[str, ...] = ()
    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    fail_on: str = str(Severity.ERROR)
    baseline: Path | None = None


def configuration_of(path: Path) -> Configuration:
    """The settings for a file: those in its folder, or in the nearest one above it that has some.

    Raises
    ------
    ReadError : the settings cannot be read, or something in them is wrong.
    """
    start = path.resolve()
    for folder in (start, *start.parents):
        for name, tables in _PLACES:
            file = folder / name
            if file.is_file() and (settings := _settings(file, tables)) is not None:
                return _Reader(file, ".".join(tables)).configuration(settings)
    return Configuration()


def _settings(file: Path, tables: tuple[str, ...]) -> Any:
    """What stands in a table of a file, None if there is no such table."""
    try:
        found: Any = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ReadError([Finding("CFG001", Severity.ERROR, f"this is no TOML: {error}", Location(file))]) from None
    for table in tables:
        if not isinstance(found, dict) or table not in found:
            return None
        found = found[table]
    return found


class _Reader:
    """Reads settings, and refuses what is not understood: a setting that has no effect is worse than an error."""

    def __init__(self, file: Path, table: str) -> None:
        self.file = file
        self.table = table

    def configuration(self, settings: Any) -> Configuration:
        if not isinstance(settings, dict):
            raise self.wrong("it has to be a table")
        if unknown := sorted(settings.keys() - _READERS.keys()):
            near = get_close_matches(unknown[0], _READERS, n=1)
            advice = f"Did you mean {near[0]!r}?" if near else f"There are: {', '.join(_READERS)}."
            raise self.wrong(f"there is no setting {unknown[0]!r}", advice)
        found = {key.replace("-", "_"): _READERS[key](self, key, value) for key, value in settings.items()}
        return Configuration(**found)

    def wrong(self, message: str, advice: str = "") -> ReadError:
        return ReadError([Finding("CFG002", Severity.ERROR, f"[{self.table}]: {message}", Location(self.file), advice)])

    def names(self, key: str, value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            raise self.wrong(f"{key!r} has to be a list of texts")
        return tuple(value)

    def profiles(self, key: str, value: Any) -> tuple[str, ...]:
        return self.names_among(key, value, tuple(map(str, Profile)))

    def targets(self, key: str, value: Any) -> tuple[str, ...]:
        return self.names_among(key, value, tuple(target.name for target in TARGETS))

    def names_among(self, key: str, value: Any, allowed: tuple[str, ...]) -> tuple[str, ...]:
        names = self.names(key, value)
        for name in names:
            self.one_of(key, name, allowed)
        return names

    def severity(self, key: str, value: Any) -> str:
        return self.one_of(key, value, tuple(map(str, Severity)))

    def one_of(self, key: str, value: Any, allowed: tuple[str, ...]) -> str:
        if value not in allowed:
            raise self.wrong(f"{key!r} cannot be {value!r}", f"It is one of {', '.join(allowed)}.")
        return str(value)

    def path(self, key: str, value: Any) -> Path:
        if not isinstance(value, str):
            raise self.wrong(f"{key!r} has to be a text")
        return self.file.parent / value


_READERS: Mapping[str, Any] = {
    "profile": _Reader.profiles,
    "targets": _Reader.targets,
    "select": _Reader.names,
    "ignore": _Reader.names,
    "fail-on": _Reader.severity,
    "baseline": _Reader.path,
}
