"""Settings of a check: given by the caller, or by a project in `pyproject.toml` or `amuros.toml`."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from amalthea_uros._internal.files import FileError, is_file, is_open_file, read_text, resolved
from amalthea_uros._internal.limits import SETTINGS_SIZE
from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.similar import similar
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.findings.targets import TARGETS
from amalthea_uros.validate.rule import RuleProfile

#: Where a project may have settings, and in which tables of the file; the first one that has them counts.
_PLACES = (("amuros.toml", ("check",)), ("pyproject.toml", ("tool", "amuros", "check")))


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckSettings:
    """How files are checked; what is not given is taken from the settings of the project.

    Attributes
    ----------
    profiles : only rules for these purposes
    select : only these rules; `*` matches anything
    ignore : not these rules, nor other findings with these ids
    fail_on : minimum severity at which the check fails; error by default
    baseline : file with the findings that are accepted
    targets : the tools for which the models are written, e.g. "inchron"; findings about other tools are only summed up
    """

    profiles: Sequence[str] = ()
    select: Sequence[str] = ()
    ignore: Sequence[str] = ()
    fail_on: Severity | None = None
    baseline: Path | None = None
    targets: Sequence[str] = ()

    def __post_init__(self) -> None:
        for name in ("profiles", "select", "ignore", "targets"):
            given = getattr(self, name)
            if isinstance(given, str):
                raise TypeError(f"{name} must be a list, e.g. [{given!r}], not the string {given!r}")
        for profile in self.profiles:
            if profile not in tuple(RuleProfile):
                raise ValueError(f"unknown profile {profile!r}; expected one of {', '.join(RuleProfile)}")
        if self.fail_on is not None and self.fail_on not in tuple(Severity):
            raise ValueError(f"unknown severity {self.fail_on!r}; expected one of {', '.join(Severity)}")

    def over(self, project: CheckSettings) -> CheckSettings:
        """These settings, and those of a project where nothing is given."""
        return CheckSettings(
            profiles=self.profiles or project.profiles,
            select=self.select or project.select,
            ignore=self.ignore or project.ignore,
            fail_on=self.fail_on or project.fail_on,
            baseline=self.baseline or project.baseline,
            targets=self.targets or project.targets,
        )


def project_settings(path: Path) -> CheckSettings:
    """The settings of the project of a file: in its folder, or in the nearest parent folder that has some.

    Raises
    ------
    ReadError : the settings cannot be read, or something in them is wrong.
    """
    start = resolved(Path() if is_open_file(path) else path)
    for folder in (start, *start.parents):
        for name, tables in _PLACES:
            file = folder / name
            if is_file(file) and (settings := _table(file, tables)) is not None:
                return _SettingsReader(file, ".".join(tables)).settings(settings)
    return CheckSettings()


def _table(file: Path, tables: tuple[str, ...]) -> Any:
    """The content of a table of a file, None if there is no such table."""
    try:
        found: Any = tomllib.loads(read_text(file, SETTINGS_SIZE))
    except FileError as error:
        raise _unreadable(file, error.reason, error.advice) from None
    except tomllib.TOMLDecodeError as error:
        raise _unreadable(file, f"not valid TOML: {error}") from None
    except RecursionError:
        raise _unreadable(file, "not valid TOML: the values are nested too deep") from None
    for table in tables:
        if not isinstance(found, dict) or table not in found:
            return None
        found = found[table]
    return found


def _unreadable(file: Path, message: str, advice: str = "") -> ReadError:
    return ReadError([Finding("CFG001", Severity.ERROR, message, Location(file), advice)])


class _SettingsReader:
    """Reads settings, and refuses what is not understood: a setting without effect is worse than an error."""

    def __init__(self, file: Path, table: str) -> None:
        self.file = file
        self.table = table

    def settings(self, table: Any) -> CheckSettings:
        if not isinstance(table, dict):
            raise self.wrong("must be a table")
        if unknown := sorted(table.keys() - _READERS.keys()):
            near = similar(unknown[0], _READERS)
            advice = f"Did you mean {near[0]!r}?" if near else f"Known settings: {', '.join(_READERS)}."
            raise self.wrong(f"unknown setting {unknown[0]!r}", advice)
        found: dict[str, Any] = {_field(key): _READERS[key](self, key, value) for key, value in table.items()}
        return CheckSettings(**found)

    def wrong(self, message: str, advice: str = "") -> ReadError:
        return ReadError([Finding("CFG002", Severity.ERROR, f"[{self.table}]: {message}", Location(self.file), advice)])

    def names(self, key: str, value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            raise self.wrong(f"{key!r} must be a list of strings")
        return tuple(value)

    def profiles(self, key: str, value: Any) -> tuple[str, ...]:
        return self.names_among(key, value, tuple(RuleProfile))

    def targets(self, key: str, value: Any) -> tuple[str, ...]:
        return self.names_among(key, value, tuple(target.name for target in TARGETS))

    def names_among(self, key: str, value: Any, allowed: tuple[str, ...]) -> tuple[str, ...]:
        names = self.names(key, value)
        for name in names:
            self.one_of(key, name, allowed)
        return names

    def severity(self, key: str, value: Any) -> Severity:
        return Severity(self.one_of(key, value, tuple(Severity)))

    def one_of(self, key: str, value: Any, allowed: tuple[str, ...]) -> str:
        if value not in allowed:
            raise self.wrong(f"{key!r} cannot be {value!r}", f"Expected one of {', '.join(allowed)}.")
        return str(value)

    def path(self, key: str, value: Any) -> Path:
        if not isinstance(value, str):
            raise self.wrong(f"{key!r} must be a string")
        return self.file.parent / value


def _field(key: str) -> str:
    """The name of the field of a key of the file."""
    return "profiles" if key == "profile" else key.replace("-", "_")


_READERS: Mapping[str, Any] = {
    "profile": _SettingsReader.profiles,
    "select": _SettingsReader.names,
    "ignore": _SettingsReader.names,
    "fail-on": _SettingsReader.severity,
    "baseline": _SettingsReader.path,
    "targets": _SettingsReader.targets,
}
