"""What a change of a system would do: the results before and after it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.impact import Impact, impact
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import Difference, apply
from amalthea_uros.design.changes.change import EXAMPLE, FORM, Change, parse_change, split_target
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.timing_changes import described
from amalthea_uros.perf.system import System
from amalthea_uros.services.changed_model import write_changed
from amalthea_uros.services.names import require_settings
from amalthea_uros.services.subject import Subject, reusable, system_of
from amalthea_uros.timing.basics.settings import Settings

#: Changes as callers give them: `{"Task.period": "2 ms"}` or `["Task.period=2ms"]`.
Changes: TypeAlias = Mapping[str, object] | Iterable[str | Change]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class WhatIf(Shown):
    """The results of a system before and after changes of its values.

    Attributes
    ----------
    before, after : the analyses of the given and of the changed system
    differences : the values before and after
    impact : the results that changed
    system : with the changes
    settings : with the changes of settings
    """

    before: Analysis
    after: Analysis
    differences: tuple[Difference, ...]
    impact: Impact
    system: System
    settings: Settings
    _subject: Subject = field(compare=False)
    _given: tuple[tuple[Change, ...], Settings]

    def __repr__(self) -> str:
        counts = ", ".join(f"{number} {effect}" for effect, number in self.impact.counts.items()) or "nothing changed"
        schedulable = f"{self.before.summary.schedulable} -> {self.after.summary.schedulable}"
        return f"<WhatIf {'; '.join(map(str, self.differences))}: schedulable {schedulable}; {counts}>"

    def save(self, path: StrPath) -> None:
        """Write the changed system as an AMALTHEA model.

        Of a model only the changed values differ; of a description or a system, the model of the changed system is built.

        Raises
        ------
        InvalidArgumentError : the model has several files, the path is not that of a model, or a change cannot be written.
        WriteError : the file cannot be written.
        """
        write_changed(self._subject, *self._given, path)


def what_if(subject: Subject, changes: Changes, settings: Settings | None = None) -> WhatIf:
    """Analyze files, an AMALTHEA model, or a system before and after changes.

    >>> what_if("app.yaml", {"Executor_Task.period": "2 ms"}).after["Executor_Task"].response  # doctest: +SKIP

    Parameters
    ----------
    changes : `{"OBJECT.KEY": value}`, or texts of the form `OBJECT.KEY=VALUE`, as for `amuros analyze --set`

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : the changes or settings name what does not exist, or a value is wrong.
    """
    given = reusable(subject)
    parsed, settings = as_changes(changes), settings or Settings()
    system = system_of(given)
    require_settings(settings, system)
    differences = described(Configuration(system, settings), parsed)
    changed = apply(system, settings, parsed)
    before, after = analyze_system(system, settings), analyze_system(*changed)
    return WhatIf(
        before=before,
        after=after,
        differences=differences,
        impact=impact(before, after),
        system=changed.system,
        settings=changed.settings,
        _subject=given,
        _given=(parsed, settings),
    )


def as_changes(changes: Changes) -> tuple[Change, ...]:
    """Changes in any of the forms that callers give.

    Raises
    ------
    InvalidArgumentError : a text is not of the form of a change.
    """
    if isinstance(changes, Mapping):
        return tuple(Change(*split_target(target, target, FORM, EXAMPLE), str(value)) for target, value in changes.items())
    if not isinstance(changes, Iterable):
        raise TypeError(f'expected changes such as {{"Task.period": "2 ms"}}, not {changes!r}')
    texts: Sequence[str | Change] = [changes] if isinstance(changes, str) else list(changes)
    return tuple(change if isinstance(change, Change) else parse_change(change) for change in texts)
