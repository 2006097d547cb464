"""Source code -> a description of its application, with gaps for what the code cannot tell."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding
from amalthea_uros.services.files import save_new


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportResult:
    """A description that was made of source code or of a recording.

    Attributes
    ----------
    path : the file that was written, None if it was not
    text : its content
    gaps : number of values to fill in
    findings : flaws of what was read, and what was not understood
    """

    path: Path | None
    text: str
    gaps: int
    findings: tuple[Finding, ...]


def import_code(
    paths: StrPath | Iterable[StrPath], target: StrPath | None = None, *, board: str | None = None, force: bool = False
) -> ImportResult:
    """Read the sources of an application that uses rclc, and describe it.

    Parameters
    ----------
    paths : C and C++ files, or folders with them, or one of these; files `*.meta` for colcon in folders are read, too
    target : the file to write; None: nothing is written
    board : the name of a platform; None: its clock is a gap
    force : replace a file that exists

    Raises
    ------
    ReadError : the sources cannot be read, or the parsers are not installed.
    WriteError : the file exists, or cannot be written.
    """
    from amalthea_uros.source.description import description_text
    from amalthea_uros.source.files import read_sources
    from amalthea_uros.source.read import read_facts
    from amalthea_uros.spec.middleware import option_units

    given = [Path(path) for path in one_or_several(paths)]
    file = None if target is None else Path(target)
    facts = read_facts(read_sources(given), board)
    name = given[0].resolve().stem if given else "app"
    text = description_text(facts, name.strip() or "app", board, option_units())
    if file is not None:
        save_new({file: text}, force=force)
    return ImportResult(path=file, text=text, gaps=count_gaps(text), findings=tuple(dict.fromkeys(facts.findings)))


def count_gaps(text: str) -> int:
    """The number of values to fill in."""
    from amalthea_uros.source.description import GAP

    return sum(line.partition(" #")[0].count(f": {GAP}") for line in text.splitlines())
