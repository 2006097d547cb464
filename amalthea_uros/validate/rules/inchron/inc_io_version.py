"""Version that the importer does not know."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule

#: Those for which am2inc has a metamodel.
VERSIONS = ("1.2.0", "2.0.0", "2.1.0", "2.2.0", "3.0.0", "3.1.0", "3.2.0", "3.3.0")


def _check(element: Amalthea, context: Context) -> Iterator[str]:
    document = element.document
    if document is not None and document.version not in VERSIONS:
        yield f"am2inc does not know AMALTHEA {document.version}"


RULE = ModelRule(
    id="INC-IO-VERSION",
    title="version that the importer does not know",
    severity=Severity.ERROR,
    target=Amalthea,
    check=_check,
    rationale="Other versions are not refused, but read as if they were 3.2.0.",
    remedy="Write the model in one of the versions 1.2.0, 2.0.0 to 2.2.0, 3.0.0 to 3.3.0.",
    fails="",
    passes="<swModel/>",
    example_version="1.0.0",
)
