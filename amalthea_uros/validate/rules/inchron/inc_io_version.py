"""Unsupported AMALTHEA version."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: The versions that am2inc supports.
VERSIONS = ("1.2.0", "2.0.0", "2.1.0", "2.2.0", "3.0.0", "3.1.0", "3.2.0", "3.3.0")


def _check(element: Amalthea, context: Context) -> Iterator[str]:
    document = element.document
    if document is not None and document.file_version not in VERSIONS:
        yield f"{spelled(document.file_version)} is not supported by am2inc"


RULE = ModelRule(
    id="INC-IO-VERSION",
    title="unsupported AMALTHEA version",
    severity=Severity.ERROR,
    target=Amalthea,
    check=_check,
    rationale="am2inc does not refuse other versions. It reads them with the metamodel of 3.2.0 and fails only at elements "
    "that 3.2.0 does not have.",
    remedy="Migrate the model to 1.2.0, 2.0.0, 2.1.0, 2.2.0, 3.0.0, 3.1.0, 3.2.0 or 3.3.0.",
    fails="",
    passes="<swModel/>",
    example_version="1.0.0",
)
