"""Duplicate key in a map."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.versions import facts
from amalthea_uros.validate.content import is_same
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.emf._facts import per_class, stored_features


def _check(element: Element, context: Context) -> Iterator[str]:
    for name, xml_name in _maps(type(element), context.version_of(element)):
        entries = element.__dict__.get(name, ())
        if len(entries) < 2:
            continue
        for key, times in Counter(entry.key for entry in entries).items():
            if times > 1:
                yield f"{xml_name} contains the key {_shown(key)} {times} times"


@per_class
def _maps(cls: type[Element], version: str) -> tuple[tuple[str, str], ...]:
    """The features that are maps, by Python and XML name."""
    classes = facts(version).classes
    features = stored_features(cls, version).items()
    return tuple(
        (name, fact.name) for name, fact in features if fact.many and fact.type in classes and classes[fact.type].entry
    )


def _fix(element: Element, context: Context) -> bool:
    """Drop exact repetitions of entries; only the author can choose between different values."""
    repaired = False
    for name, _ in _maps(type(element), context.version_of(element)):
        entries = element.__dict__.get(name, [])
        for entry in list(entries):
            if any(is_same(entry, other) for other in entries[: entries.index(entry)]):
                entries.remove(entry)
                repaired = True
    return repaired


def _shown(key: str | Element | None) -> str:
    return repr(key.qualified_name if isinstance(key, Element) else key)


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/map-entry-unique",
    title="duplicate key in a map",
    severity=Severity.ERROR,
    target=Element,
    check=_check,
    concerns=_maps,
    fix=_fix,
    rationale="Only one of the values takes effect, and which one is undefined. APP4MC's validation also reports it.",
    remedy="Define each key only once.",
    fails="""
<swModel>
  <tasks name="T">
    <customProperties key="k">
      <value xsi:type="am:StringObject" value="1"/>
    </customProperties>
    <customProperties key="k">
      <value xsi:type="am:StringObject" value="2"/>
    </customProperties>
  </tasks>
</swModel>
""",
    edits={
        """    <customProperties key="k">
      <value xsi:type="am:StringObject" value="2"/>
    </customProperties>
""": "",
    },
)
