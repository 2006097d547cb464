"""Files of any version -> one linked set of nodes."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from pathlib import Path

from amalthea_uros._internal.files import is_file, resolved
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import ReadError
from amalthea_uros.xmi.files import FileText, read_text
from amalthea_uros.xmi.migrate.link import file_of, link
from amalthea_uros.xmi.migrate.model_set import ModelSet, Origins
from amalthea_uros.xmi.migrate.notes import StepNotes
from amalthea_uros.xmi.migrate.parse import ParsedFile, parse

#: What the names of model files begin their suffix with: `.amxmi`, in ITEA versions also `.amxmi-sw` and the like.
SUFFIX = ".amxmi"


def read_set(
    files: Iterable[tuple[Path, FileText]], max_size: int, notes: StepNotes, elsewhere: Collection[Path] = ()
) -> ModelSet:
    """Read some files, and those to which they refer by file names, as one set.

    Parameters
    ----------
    elsewhere : files that are read in another way, and that do not become part of the set

    Raises
    ------
    ReadError : a file cannot be read; carries the findings of all of them.
    """
    origins = Origins()
    parsed: list[ParsedFile] = []
    refused: list[Finding] = []
    waiting = list(files)
    known = {resolved(path) for path in (*elsewhere, *(path for path, _ in waiting))}
    while waiting:
        path, content = waiting.pop(0)
        try:
            parsed.append(parse(path, content, origins, notes))
        except ReadError as error:
            refused += error.findings
            continue
        for other in dict.fromkeys(file_of(href.text) for href in parsed[-1].hrefs):
            found = path.parent / other
            # A missing file is reported with the references to it.
            if other and SUFFIX in found.suffix and resolved(found) not in known and is_file(found):
                known.add(resolved(found))
                try:
                    waiting.append((found, read_text(found, max_size)))
                except ReadError as error:
                    refused += error.findings
    if refused:
        raise ReadError(refused)
    return link(parsed, origins, notes)
