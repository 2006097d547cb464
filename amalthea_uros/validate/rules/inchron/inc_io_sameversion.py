"""Files of different AMALTHEA versions."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._importer import metamodel_of


def _check(element: Amalthea, context: Context) -> Iterator[str]:
    first, *others = context.model.documents
    document = element.document
    if document in others and metamodel_of(document) != metamodel_of(first):
        other = repr(first.path.name) if first.path else "the first file"
        yield f"the file uses {spelled(document.file_version)}, but {other} uses {first.file_version}"


RULE = ModelRule(
    id="INC-IO-SAMEVERSION",
    title="files of different AMALTHEA versions",
    severity=Severity.ERROR,
    target=Amalthea,
    check=_check,
    rationale="am2inc aborts the conversion if the files need different metamodels. It reads all 3.x versions with the "
    "metamodel of 3.2.0.",
    remedy="Migrate all files of the model to the same version.",
    fails="""
<!-- a file of AMALTHEA 2.2.0 beside one of 3.3.0 -->
<swModel/>
""",
    edits={"2.2.0 beside one of 3.3.0": "3.3.0 beside another one"},
    example_version="2.2.0",
    beside="<hwModel/>",
)
