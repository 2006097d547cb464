"""Base of the AMALTHEA classes: features, containment known from both ends, walking.

The generated classes declare one feature per line::

    class Task(Process):
        preemption: Preemption | None = attribute("preemption")
        stimuli: list[Stimulus] = references("stimuli")

A feature is unset (`None`, or an empty list) until something is assigned; defaults are a matter of the AMALTHEA version and are
asked with `Element.effective`. Values live in the instance dictionary; the descriptors below only answer for unset features, so
that a read costs no more than that of an ordinary attribute and an object of which three of twenty features are set stays small.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, SupportsIndex, TypeVar, dataclass_transform

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Document, Model

E = TypeVar("E", bound="Element")

#: `either` is a containment in some versions and a reference in others (the data type of labels and channels).
FeatureKind = Literal["attribute", "reference", "containment", "either"]

_set = object.__setattr__


class Revision:
    """Counts the changes of names and containment in this process; look-up tables made earlier are stale."""

    number: ClassVar[int] = 0


#: Features on which the unique name of their holder, or of its parts, may depend.
_NAMING = frozenset({"name", "namespace", "parameter", "runnable"})


class Feature:
    """One feature of a class; as a descriptor it answers for the unset value."""

    __slots__ = ("kind", "many", "name", "xml_name")

    def __init__(self, xml_name: str, kind: FeatureKind, many: bool = False) -> None:
        self.name = ""
        self.xml_name = xml_name
        self.kind: FeatureKind = kind
        self.many = many

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, instance: Element | None, owner: type) -> Any:
        if instance is None:
            return self
        if not self.many:
            return None
        empty: list[Any] = self.new_list(instance, ())
        _set(instance, self.name, empty)
        return empty

    def new_list(self, owner: Element, values: Iterable[Any]) -> list[Any]:
        """A list for the values of this feature."""
        return (ContainmentList if self.kind == "containment" else ReferenceList)(owner, values)

    def copied(self, owner: Element, values: Iterable[Any]) -> list[Any]:
        """A list for values whose container is the owner already."""
        found: list[Any] = self.new_list(owner, ())
        list.extend(found, values)
        return found

    def contains(self, value: object) -> bool:
        """Whether an object held by this feature is part of its holder."""
        if self.kind == "either":
            return isinstance(value, Element) and not value.is_referable
        return self.kind == "containment"

    def __repr__(self) -> str:
        return f"<{self.kind} {self.xml_name}{' *' if self.many else ''}>"


# The generated classes call these five; their static type is the annotation of the feature.


def attribute(xml_name: str) -> Any:
    """A number, text, truth value or literal."""
    return Feature(xml_name, "attribute")


def reference(xml_name: str) -> Any:
    """A reference to an object that lives elsewhere."""
    return Feature(xml_name, "reference")


def references(xml_name: str) -> Any:
    """Ordered references to objects that live elsewhere."""
    return Feature(xml_name, "reference", many=True)


def containment(xml_name: str) -> Any:
    """A part of the object."""
    return Feature(xml_name, "containment")


def containments(xml_name: str) -> Any:
    """Ordered parts of the object."""
    return Feature(xml_name, "containment", many=True)


def containment_or_reference(xml_name: str) -> Any:
    """A part of the object in older versions, a reference in newer ones."""
    return Feature(xml_name, "either")


@dataclass
class Extras:
    """What stands at an object in a file and has no place in the metamodel; it is written back.

    Attributes
    ----------
    attributes : unknown attributes, name and value, and known ones whose text is no value of their type
    content : unknown elements, comments, processing instructions and text as they stand in the file, each with the part in
        front of which it stands (None: at the end)
    """

    attributes: dict[str, str] = field(default_factory=dict)
    content: list[tuple[Element | None, str]] = field(default_factory=list)


@dataclass_transform(kw_only_default=True, eq_default=False)
class Element:
    """Any object of an AMALTHEA model.

    Objects are equal only to themselves. An object has at most one container: putting it into a second one takes it out of the
    first.
    """

    __slots__ = ("_container", "_document", "_reference")

    _container: Element | None

    is_abstract: ClassVar[bool] = True
    is_referable: ClassVar[bool] = False

    def __init_subclass__(cls, abstract: bool = False) -> None:
        cls.is_abstract = abstract
        cls.is_referable = any(base.__name__ == "IReferable" for base in cls.__mro__)

    def __new__(cls, *_args: Any, **_features: Any) -> Self:
        self = object.__new__(cls)
        _set(self, "_container", None)
        return self

    def __init__(self, **features: Any) -> None:
        if self.is_abstract:
            raise TypeError(f"{type(self).__name__} is abstract, create one of its subclasses")
        for name, value in features.items():
            setattr(self, name, value)

    if not TYPE_CHECKING:  # else mypy would allow the assignment of any name

        def __setattr__(self, name: str, value: Any) -> None:
            feature = features_of(type(self)).get(name)
            if feature is None:
                raise AttributeError(_unknown_feature(type(self), name))
            if feature.many:
                value = list(value)
                held = self.__dict__.get(name)
                if held and feature.kind == "containment":
                    held.clear()
                value = feature.new_list(self, value)
            elif feature.kind != "attribute":
                old = self.__dict__.get(name)
                if old is value:
                    return
                if old is not None and feature.contains(old):
                    release(old)
                if value is not None and feature.contains(value):
                    adopt(self, value)
            _set(self, name, value)
            touch(self, renames=name in _NAMING)

        def __delattr__(self, name: str) -> None:
            feature = features_of(type(self)).get(name)
            if feature is None:
                raise AttributeError(_unknown_feature(type(self), name))
            setattr(self, name, [] if feature.many else None)

    def __deepcopy__(self, memo: dict[int, Any]) -> Element:
        """A detached copy with copies of all parts; references to objects outside lead to the same objects."""
        copies = {element: object.__new__(type(element)) for element in self.walk()}
        for element, twin in copies.items():
            holder = element._container
            _set(twin, "_container", copies.get(holder) if holder is not None and element is not self else None)
            for name, value in element.__dict__.items():
                if isinstance(value, ReferenceList):
                    value = features_of(type(twin))[name].copied(twin, [copies.get(item, item) for item in value])
                elif isinstance(value, Element):
                    value = copies.get(value, value)
                elif isinstance(value, Extras):
                    content = [(copies.get(anchor, anchor) if anchor else None, raw) for anchor, raw in value.content]
                    value = Extras(dict(value.attributes), content)
                _set(twin, name, value)
        memo[id(self)] = copies[self]
        return copies[self]

    def __reduce_ex__(self, _protocol: SupportsIndex) -> Any:
        raise TypeError(
            f"{self!r} is neither pickled nor copied without its parts: use copy.deepcopy, or save and load the model"
        )

    def __repr__(self) -> str:
        name = self.__dict__.get("name")
        return f"<{type(self).__name__} {name!r}>" if name else f"<{type(self).__name__}>"

    def __dir__(self) -> list[str]:
        return sorted({*object.__dir__(self), *features_of(type(self))})

    @property
    def container(self) -> Element | None:
        """The object that this one is part of; None for a root, an unresolved or a detached object."""
        return self._container

    @property
    def document(self) -> Document | None:
        """The file (to be) that holds this object; None while it is not part of one."""
        top: Element = self
        while top._container is not None:
            top = top._container
        return getattr(top, "_document", None)

    @property
    def model(self) -> Model | None:
        """The model that holds this object."""
        document = self.document
        return document.model if document else None

    @property
    def unresolved(self) -> str | None:
        """The text of the reference for which no object was found; None for every real object.

        A reference into a file that was not read, or to nothing at all, leads to such a stand-in of the right class.
        """
        return getattr(self, "_reference", None)

    @property
    def extras(self) -> Extras | None:
        """What stands at the object in its file and is unknown to the metamodel, None if nothing. It may be changed."""
        found: Extras | None = self.__dict__.get("_extras")
        if found is not None:
            touch(self)
        return found

    @property
    def unique_name(self) -> str:
        """The id under which references find this object, e.g. `Board/eth0?type=HwPort`."""
        from amalthea_uros.metamodel.naming import unique_name

        return unique_name(self)

    @property
    def qualified_name(self) -> str:
        """Name with the names that set it apart from others, joined by `.`; for an unnamed object where it stands."""
        from amalthea_uros.metamodel.naming import qualified_name

        return qualified_name(self)

    def effective(self, feature_name: str) -> Any:
        """The value of a feature, or what its absence stands for in the AMALTHEA version of the object's document.

        Raises
        ------
        AttributeError : the class has no such feature.
        """
        from amalthea_uros.metamodel.defaults import effective

        return effective(self, feature_name)

    def contents(self) -> Iterator[Element]:
        """The direct parts, in the order of the features."""
        values = self.__dict__
        for feature in containments_of(type(self)):
            value = values.get(feature.name)
            if value is None:
                continue
            if feature.many:
                yield from value
            elif feature.contains(value):
                yield value

    def walk(self) -> Iterator[Element]:
        """The object itself and all its parts, parents before children."""
        stack = [self]
        while stack:
            element = stack.pop()
            yield element
            stack.extend(reversed(tuple(element.contents())))

    def enclosing(self, cls: type[E]) -> E | None:
        """The nearest container of a class (the Task in which a call stands), None if there is none."""
        element = self._container
        while element is not None and not isinstance(element, cls):
            element = element._container
        return element


class ReferenceList(list[E]):
    """References of one object, in order; its document learns of every change."""

    __slots__ = ("_owner",)

    def __init__(self, owner: Element, values: Iterable[E] = ()) -> None:
        super().__init__(values)
        self._owner = owner

    def append(self, value: E) -> None:
        super().append(value)
        touch(self._owner)

    def insert(self, index: SupportsIndex, value: E) -> None:
        super().insert(index, value)
        touch(self._owner)

    def extend(self, values: Iterable[E]) -> None:
        super().extend(values)
        touch(self._owner)

    def __iadd__(self, values: Iterable[E]) -> Self:  # type: ignore[override, misc]
        self.extend(values)
        return self

    def __imul__(self, times: SupportsIndex) -> Self:
        super().__imul__(times)
        touch(self._owner)
        return self

    def __setitem__(self, index: Any, value: Any) -> None:
        super().__setitem__(index, value)
        touch(self._owner)

    def __delitem__(self, index: Any) -> None:
        super().__delitem__(index)
        touch(self._owner)

    def remove(self, value: E) -> None:
        super().remove(value)
        touch(self._owner)

    def pop(self, index: SupportsIndex = -1) -> E:
        value = super().pop(index)
        touch(self._owner)
        return value

    def clear(self) -> None:
        super().clear()
        touch(self._owner)

    def sort(self, *, key: Any = None, reverse: bool = False) -> None:
        super().sort(key=key, reverse=reverse)
        touch(self._owner)

    def reverse(self) -> None:
        super().reverse()
        touch(self._owner)

    def __reduce__(self) -> tuple[Any, ...]:
        return (list, (list(self),))


class ContainmentList(ReferenceList[E]):
    """Parts of one object, in order. Every way of putting an object in makes the owner its container."""

    __slots__ = ()

    def __init__(self, owner: Element, values: Iterable[E] = ()) -> None:
        super().__init__(owner)
        for value in values:
            self.append(value)

    def append(self, value: E) -> None:
        adopt(self._owner, value)
        super().append(value)

    def insert(self, index: SupportsIndex, value: E) -> None:
        adopt(self._owner, value)
        super().insert(index, value)

    def extend(self, values: Iterable[E]) -> None:
        for value in list(values):
            self.append(value)

    def __imul__(self, times: SupportsIndex) -> Self:
        raise TypeError("an object can be a part only once")

    def __setitem__(self, index: Any, value: Any) -> None:
        values = list(self)
        values[index] = value
        self.clear()
        self.extend(values)

    def __delitem__(self, index: Any) -> None:
        for value in self[index] if isinstance(index, slice) else [self[index]]:
            release(value)
        super().__delitem__(index)

    def remove(self, value: E) -> None:
        del self[self.index(value)]

    def pop(self, index: SupportsIndex = -1) -> E:
        release(self[index])
        return super().pop(index)

    def clear(self) -> None:
        del self[:]


def extras_of(element: Element) -> Extras:
    """The extras of an object, to be added to."""
    found: Extras = element.__dict__.setdefault("_extras", Extras())
    return found


def touch(element: Element, renames: bool = False) -> None:
    """Tell the document that an object changed, and whether references to it, or to its parts, may have to as well."""
    path = path_of(element)
    if renames:
        Revision.number += 1
    document: Document | None = getattr(path[-1], "_document", None)
    if document is not None:
        document.changes.note(path, renames)


def path_of(element: Element) -> list[Element]:
    """The object, its container, and so on up to the root."""
    path = [element]
    while (holder := path[-1]._container) is not None:
        path.append(holder)
    return path


def release(value: Element) -> None:
    """Take the container from an object that is about to be taken out of it."""
    touch(value, renames=True)
    _set(value, "_container", None)


def adopt(owner: Element, value: Element) -> None:
    """Make `owner` the container of `value`, taking it out of the old one."""
    if not isinstance(value, Element):
        raise TypeError(f"{owner!r} cannot contain {value!r}: not a model object")
    ancestor: Element | None = owner
    while ancestor is not None:
        if ancestor is value:
            raise ValueError(f"{value!r} cannot become a part of {owner!r}, which is part of it")
        ancestor = ancestor._container
    _take_out(value)
    _set(value, "_container", owner)
    touch(value, renames=True)


def _take_out(value: Element) -> None:
    holder = value._container
    if holder is None:
        return
    for feature in containments_of(type(holder)):
        held = holder.__dict__.get(feature.name)
        if held is value:
            release(value)
            _set(holder, feature.name, None)
        elif feature.many and held and any(element is value for element in held):
            held.remove(value)


_FEATURES: dict[type, dict[str, Feature]] = {}
_CONTAINMENTS: dict[type, tuple[Feature, ...]] = {}


def features_of(cls: type[Element]) -> dict[str, Feature]:
    """All features of a class by their Python names, those of the supertypes first."""
    found = _FEATURES.get(cls)
    if found is None:
        found = {}
        for base in reversed(cls.__mro__):
            found.update((name, value) for name, value in vars(base).items() if isinstance(value, Feature))
        _FEATURES[cls] = found
    return found


def containments_of(cls: type[Element]) -> tuple[Feature, ...]:
    """The features of a class that may hold parts."""
    found = _CONTAINMENTS.get(cls)
    if found is None:
        found = tuple(f for f in features_of(cls).values() if f.kind in ("containment", "either"))
        _CONTAINMENTS[cls] = found
    return found


def references_of(element: Element) -> Iterator[tuple[str, Any]]:
    """The references of an object that are set: feature name, and the target or the list of targets."""
    for name, value in element.__dict__.items():
        if isinstance(value, Element):
            if not features_of(type(element))[name].contains(value):
                yield name, value
        elif type(value) is ReferenceList and value:
            yield name, value


def _unknown_feature(cls: type[Element], name: str) -> str:
    near = get_close_matches(name, features_of(cls), n=1)
    hint = f", did you mean {near[0]!r}?" if near else ""
    return f"{cls.__name__} has no feature {name!r}{hint}"
