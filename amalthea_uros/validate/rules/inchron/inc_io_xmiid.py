"""Missing xmi:id."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.parse import unquote_plus

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Amalthea, LocalModeLabel
from amalthea_uros.metamodel.element import Element, references_of
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.model import Document
from amalthea_uros.metamodel.naming import unique_name
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule
from amalthea_uros.validate.rules.inchron._importer import has_encoded_name, has_id, without_namespace
from amalthea_uros.validate.rules.inchron.missing_references import is_needed


def _check(element: Amalthea, context: Context) -> Iterator[str | Downgraded]:
    document = element.document
    label = next((label for label in context.all(LocalModeLabel) if label.document is document), None)
    if label is not None and document in context.once(_with_missing_ids):
        yield f"the file has local mode labels, e.g. {label.name or ''!r}, and objects without an xmi:id"
    lost = {target: is_crash for target, is_crash in context.once(_lost).items() if target.document is document}
    members = context.once(without_namespace)
    for why, targets in (
        ("references with its namespace", [target for target in lost if target in members]),
        ("references that encode its name", [target for target in lost if target not in members]),
    ):
        # An object that am2inc needs is the better example.
        for target in sorted(targets, key=lost.__getitem__, reverse=True)[:1]:
            message = f"{unique_name(target)!r} has no xmi:id, so {why} cannot be resolved"
            yield message if lost[target] else Downgraded(message)


def _with_missing_ids(context: Context) -> set[Document | None]:
    """The files with local mode labels or targets of references that have no `xmi:id`."""
    objects = {*context.all(LocalModeLabel), *(target for _, _, target in _references(context))}
    return {element.document for element in objects if not has_id(element)}


def _lost(context: Context) -> dict[Element, bool]:
    """The objects to which am2inc cannot resolve references, and whether it needs one of these references."""
    found: dict[Element, bool] = {}
    members = context.once(without_namespace)
    for holder, name, target in _references(context):
        if target in members or (has_encoded_name(target) and not has_id(target) and not _is_plain(holder, name, target)):
            xml_name = features_of(type(holder))[name].xml_name
            found[target] = found.get(target, False) or is_needed(holder, xml_name)
    return found


def _references(context: Context) -> Iterator[tuple[Element, str, Element]]:
    """The resolved references: object, feature and target."""
    for holder in context.all(Element):
        for name, value in references_of(holder):
            for target in value if isinstance(value, list) else (value,):
                if target.unresolved is None:
                    yield holder, name, target


def _is_plain(holder: Element, name: str, target: Element) -> bool:
    """Whether a reference is written without encoding, as am2inc computes names."""
    document, plain = holder.document, unquote_plus(unique_name(target))
    return document is not None and (holder, f"{features_of(type(holder))[name].xml_name} {plain}") in document.spellings


RULE = ModelRule(
    id="INC-IO-XMIID",
    title="missing xmi:id",
    severity=Severity.ERROR,
    target=Amalthea,
    check=_check,
    rationale="Without an xmi:id am2inc resolves references by name. It then refuses files with local mode labels, and does not "
    "find objects in a namespace or with characters that references encode, such as spaces, slashes and umlauts: it crashes with a "
    "segmentation fault if it needs the object, and otherwise loses the reference (warning).",
    remedy="Save the file with APP4MC or amuros fmt, which write an xmi:id for every object.",
    fails="""
<swModel>
  <tasks name="T">
    <localLabels name="l"/>
  </tasks>
</swModel>
""",
    edits={
        '<tasks name="T"': '<tasks xmi:id="T?type=Task" name="T"',
        '<localLabels name="l"': '<localLabels xmi:id="T/l?type=LocalModeLabel" name="l"',
    },
)
