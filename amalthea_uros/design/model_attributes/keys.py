"""The keys of a model: a path of names for each attribute, quantity and reference that its objects have, or could have."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.key_names import only_one, shorter_names, with_gaps
from amalthea_uros.metamodel.classes_common import (
    BigIntegerObject,
    BooleanObject,
    DoubleObject,
    FloatObject,
    IntegerObject,
    LongObject,
    Quantity,
    StringObject,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.xmi.emf.plan import ClassPlan, FeaturePlan, Plans, plans

#: Objects that are one value, not a part with attributes of its own.
SINGLE_VALUES = (
    Quantity,
    IntegerObject,
    BigIntegerObject,
    LongObject,
    FloatObject,
    DoubleObject,
    StringObject,
    BooleanObject,
)
#: Names are what objects are matches by, and say nothing about timing.
_IDENTITY = ("name", "namespace")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ModelKey:
    """A value of an object.

    Attributes
    ----------
    holder : the object
    feature : its feature with the value
    part : the present value if it is an object of its own, such as a time with its unit; otherwise None
    path : of the value: features, and numbers of objects in lists
    names : the same with the names of objects in place of their numbers
    """

    holder: Element
    feature: FeaturePlan
    part: Element | None = None
    path: tuple[str | int, ...]
    names: tuple[str, ...]

    @property
    def full_name(self) -> str:
        """All names."""
        return ".".join(self.names)

    @property
    def spellings(self) -> tuple[str, ...]:
        """The last name, and what it is called in files."""
        return (self.names[-1], self.feature.xml_name) if self.names[-1] == self.feature.name else (self.names[-1],)


def keys_of(model: Model) -> Iterator[ModelKey]:
    """All keys of a model, in the order of its files."""
    for document in model.documents:
        yield from _KeysOfDocument(document).keys(document.root, (), ())


class _KeysOfDocument:
    """Goes through the objects of a document."""

    def __init__(self, document: Document) -> None:
        self.plans: Plans = plans(document.facts_version)

    def keys(self, holder: Element, path: tuple[str | int, ...], names: tuple[str, ...]) -> Iterator[ModelKey]:
        """The keys of an object and of its parts."""
        plan = self.plans.of(type(holder).__name__)
        if plan is None:
            return
        is_entry = self.plans.facts.classes[type(holder).__name__].entry
        for feature in plan.features:
            if feature.data_type is not None or feature.is_reference:
                if feature.name not in _IDENTITY and not (is_entry and feature.name == "key"):
                    yield self._key(holder, feature, path, names, is_entry=is_entry)
                continue
            value = holder.__dict__.get(feature.name)
            if feature.many:
                yield from self._listed(holder, feature, value or (), path, names)
            elif isinstance(value, SINGLE_VALUES) or (value is None and issubclass(feature.target, Quantity)):
                yield self._key(holder, feature, path, names, part=value, is_entry=is_entry)
            elif value is not None:
                own = (name,) if (name := value.__dict__.get("name")) else ()
                yield from self.keys(value, (*path, feature.name), (*names, feature.name, *own))

    def _key(
        self,
        holder: Element,
        feature: FeaturePlan,
        path: tuple[str | int, ...],
        names: tuple[str, ...],
        *,
        part: Element | None = None,
        is_entry: bool = False,
    ) -> ModelKey:
        """The key of a feature; the value of a map entry has the name of the entry."""
        if is_entry and feature.name == "value":
            return ModelKey(holder=holder, feature=feature, part=part, path=path, names=names)
        return ModelKey(holder=holder, feature=feature, part=part, path=(*path, feature.name), names=(*names, feature.name))

    def _listed(
        self,
        holder: Element,
        feature: FeaturePlan,
        items: Sequence[Element],
        path: tuple[str | int, ...],
        names: tuple[str, ...],
    ) -> Iterator[ModelKey]:
        for index, (item, own) in enumerate(zip(items, self._item_names(items), strict=True)):
            item_path, item_names = (*path, feature.name, index), (*names, feature.name, *own)
            if isinstance(item, SINGLE_VALUES):
                yield ModelKey(holder=holder, feature=feature, part=item, path=item_path, names=item_names)
            else:
                yield from self.keys(item, item_path, item_names)

    def _item_names(self, items: Sequence[Element]) -> Iterator[tuple[str, ...]]:
        """The names of each object of a list: with its number if it is not the only one with the name, or has none."""
        own = [_name_of(item, self.plans.of(type(item).__name__)) for item in items]
        counts = Counter(own)
        for index, name in enumerate(own):
            yield (name,) if name and counts[name] == 1 else (name, str(index)) if name else (str(index),)


def _name_of(item: Element, plan: ClassPlan | None) -> str:
    """The name of an object, or that of the first object that it refers to, such as the task of an allocation; "" for none."""
    name = item.__dict__.get("name") or item.__dict__.get("key")
    if isinstance(name, str):
        return name
    for feature in plan.features if plan is not None and not isinstance(item, SINGLE_VALUES) else ():
        target = item.__dict__.get(feature.name) if feature.is_reference and not feature.many else None
        if target is not None and target.__dict__.get("name"):
            return str(target.__dict__["name"])
    return ""


def with_last_name(target: str, keys: Iterable[ModelKey]) -> list[tuple[str, ModelKey]]:
    """The keys whose last name is that of a target, each with the target as this key spells it."""
    matches = []
    for key in keys:
        for spelling in key.spellings:
            if target == spelling or target.endswith(f".{spelling}"):
                matches.append((target.removesuffix(spelling) + key.names[-1], key))
                break
    return matches


def matching(target: str, keys: Iterable[ModelKey]) -> list[ModelKey]:
    """The keys that are meant by some of their names, the last one among them; the fewest gaps between these count."""
    spelled = with_last_name(target, keys)
    matches: list[ModelKey] = []
    for name in dict.fromkeys(name for name, _ in spelled):
        gaps = with_gaps(name, _of(name, spelled))
        matches += (
            [key for gap, key in gaps if gap == 0]
            or [key for _, key in gaps if name in shorter_names(key)]
            or [key for _, key in gaps]
        )
    return matches


def _of(name: str, spelled: Iterable[tuple[str, ModelKey]]) -> list[ModelKey]:
    return [key for each, key in spelled if each == name]


def the_key(target: str, keys: Sequence[ModelKey]) -> ModelKey | None:
    """The key with a name, None if there is none.

    Raises
    ------
    InvalidArgumentError : the name means several keys.
    """
    return only_one(target, matching(target, keys), "model", lambda several: list(short_names(several, keys).values()))


def short_names(some: Sequence[ModelKey], keys: Iterable[ModelKey]) -> dict[ModelKey, str]:
    """The shortest name of each of some keys that means no other one, if possible with the object that has it."""
    lasts = {key.names[-1] for key in some}
    counts = Counter(name for key in keys if key.names[-1] in lasts for name in dict.fromkeys(_names(key)))
    return {key: next((name for name in _names(key) if counts[name] == 1), key.full_name) for key in some}


def _names(key: ModelKey) -> Iterator[str]:
    """The names by which a key is shown: none that begins with a number."""
    return (name for name in shorter_names(key) if not name[0].isdigit())
