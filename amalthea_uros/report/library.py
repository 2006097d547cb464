"""Reports for callers of the library."""

from __future__ import annotations

from functools import cached_property
from io import StringIO
from pathlib import Path

from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.change import Changes
from amalthea_uros.report import formats
from amalthea_uros.services.files import save_text
from amalthea_uros.services.report import ReportContent, compile_report
from amalthea_uros.services.subject import Subject
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.basics.stated_times import TimeLike, stated_time


@dataclass(frozen=True)
class Report:
    """A report of a system.

    Attributes
    ----------
    content : what it shows
    """

    content: ReportContent

    @cached_property
    def html(self) -> str:
        """One page that needs nothing outside of itself."""
        return self._text("html")

    @cached_property
    def markdown(self) -> str:
        """A summary, short enough for a comment on GitHub."""
        return self._text("markdown")

    def save(self, path: StrPath) -> None:
        """Write it; the suffix says the format: .html, .md, .mmd (Mermaid) or .dot (Graphviz) of the data flow.

        Raises
        ------
        InvalidArgumentError : another suffix.
        WriteError : the file cannot be written.
        """
        save_text(path, self._text(formats.format_of(Path(path))))

    def _text(self, name: str) -> str:
        stream = StringIO()
        formats.write(name, self.content, stream)
        return stream.getvalue()

    def __repr__(self) -> str:
        return f"<Report of {self.content.title}: schedulable {self.content.analysis.summary.schedulable}>"


def report(
    subject: Subject,
    settings: Settings | None = None,
    *,
    changes: Changes = (),
    duration: TimeLike | None = None,
    seed: int = 1,
    with_simulation: bool = True,
    with_bus: bool = False,
    title: str | None = None,
    date: str = "",
) -> Report:
    """Analyze, simulate and check files, an AMALTHEA model or a system, and report on it.

    >>> report("app.yaml").save("report.html")  # doctest: +SKIP

    Parameters
    ----------
    changes : such as `{"Executor_Task.period": "2 ms"}`, or texts as for `amuros report --set`
    duration : of the simulation, such as "1 s"; None: so long that the work is limited
    with_bus : with the messages on the CAN bus of an `app.yaml`
    title : None: the names of the files
    date : shown below the title; without one, the same input gives the same report

    Raises
    ------
    ReadError, InvalidArgumentError : as for `compile_report`.
    """
    content = compile_report(
        subject,
        settings,
        changes=changes,
        with_bus=with_bus,
        with_simulation=with_simulation,
        duration=None if duration is None else stated_time("the duration", duration),
        seed=seed,
        title=title,
        date=date,
    )
    return Report(content)
