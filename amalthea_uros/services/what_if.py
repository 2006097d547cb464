"""What a change of a system would do: the results before and after it."""

from __future__ import annotations

from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.impact import Impact, impact
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.change import Change, Changes
from amalthea_uros.perf.system import System
from amalthea_uros.services.changed import open_changed
from amalthea_uros.services.changed_model import write_changed
from amalthea_uros.services.subject import Subject
from amalthea_uros.timing.basics.settings import Settings


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
    changed = open_changed(subject, settings, changes)
    before, after = analyze_system(*changed.given), analyze_system(changed.system, changed.settings)
    return WhatIf(
        before=before,
        after=after,
        differences=changed.differences,
        impact=impact(before, after),
        system=changed.system,
        settings=changed.settings,
        _subject=changed.opened.subject,
        _given=(changed.changes, changed.given.settings),
    )
