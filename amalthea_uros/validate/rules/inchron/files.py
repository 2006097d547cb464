"""Versions and sub-models of files."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea, CustomProperty
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._importer import metamodel_of

#: The versions that am2inc supports.
VERSIONS = ("1.2.0", "2.0.0", "2.1.0", "2.2.0", "3.0.0", "3.1.0", "3.2.0", "3.3.0")


def _check_version(element: Amalthea, context: Context) -> Iterator[str | Downgraded]:
    document = element.document
    if document is not None and document.file_version not in VERSIONS:
        message = f"{spelled(document.file_version)} is not supported by am2inc"
        yield Downgraded(message) if document.migrated_from is None else message


def _check_same_version(element: Amalthea, context: Context) -> Iterator[str]:
    first, *others = context.model.documents
    document = element.document
    if document in others and metamodel_of(document) != metamodel_of(first):
        other = repr(first.path.name) if first.path else "the first file"
        yield f"the file uses {spelled(document.file_version)}, but {other} uses {first.file_version}"


def _check_sub_models(element: Amalthea, context: Context) -> Iterator[str]:
    holders = context.once(_holders)
    for part in element.contents():
        first = holders.get(type(part), element)
        if first is not element:
            document = first.document
            other = repr(document.path.name) if document is not None and document.path else "another file"
            yield f"the {type(part).__name__} replaces the one in {other}"


def _holders(context: Context) -> dict[type[Element], Element]:
    """The root of the first file that has a sub-model, by class of sub-model."""
    found: dict[type[Element], Element] = {}
    for document in context.model.documents:
        for part in document.root.contents():
            if not isinstance(part, CustomProperty):
                found.setdefault(type(part), document.root)
    return found


RULES = (
    ModelRule(
        id="INC-IO-VERSION",
        title="unsupported AMALTHEA version",
        severity=Severity.ERROR,
        target=Amalthea,
        check=_check_version,
        rationale="am2inc reads other versions with the metamodel of 3.2.0. It refuses nearly all files before 0.9.7, and those of "
        "other versions only if they use what 3.2.0 does not have, which INC-IO-FEATURE reports (warning).",
        remedy="Migrate the model to 1.2.0, 2.0.0, 2.1.0, 2.2.0, 3.0.0, 3.1.0, 3.2.0 or 3.3.0.",
        fails="",
        passes="<swModel/>",
        example_version="0.9.0",
        is_about_files=True,
    ),
    ModelRule(
        id="INC-IO-SAMEVERSION",
        title="files of different AMALTHEA versions",
        severity=Severity.ERROR,
        target=Amalthea,
        check=_check_same_version,
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
    ),
    ModelRule(
        id="INC-IO-SUBMODEL-ONCE",
        title="sub-model in several files",
        severity=Severity.ERROR,
        target=Amalthea,
        check=_check_sub_models,
        rationale="am2inc does not merge sub-models: the one in a later file silently replaces the one in an earlier file. "
        "It then crashes with a segmentation fault or writes an incomplete model.",
        remedy="Move the content of each sub-model into one file.",
        fails="""
<!-- beside a file that has an swModel, too -->
<swModel>
  <tasks name="T"/>
</swModel>
""",
        passes="""
<!-- beside a file that has an swModel -->
<hwModel/>
""",
        beside="<swModel/>",
    ),
)
