"""Base of the AMALTHEA classes.

The generated classes declare one feature per line, each with its documentation below it if the name does not say all::

    class Task(Process):
        preemption: Preemption | None = attribute("preemption")
        stimuli: list[Stimulus] = references("stimuli")

A feature is unset (`None`, or an empty list) until something is assigned; defaults are a matter of the AMALTHEA version and are
requested with `Element.effective`. Values are kept in the instance dictionary; the descriptors of `features.py` only serve unset
features, so that a read costs no more than that of an ordinary attribute and an object of which three of twenty features are set
stays small.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, ClassVar, Self, SupportsIndex, TypeVar, dataclass_transform

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.metamodel.containment import ReferenceList, attach, detach, mark_modified
from amalthea_uros.metamodel.features import containments_of, features_of

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Document, Model

E = TypeVar("E", bound="Element")

#: Features on which the unique name of their holder, or of its parts, may depend.
_NAMING = frozenset({"name", "namespace", "parameter", "runnable"})

_set = object.__setattr__


@dataclass
class Extras:
    """Content of an object in a file that the metamodel cannot represent; it is preserved when the file is saved.

    Attributes
    ----------
    attributes : unknown attributes, name and value, and known ones with a value of the wrong type
    content : unknown elements, comments, processing instructions and text as written in the file, each with the part that
        follows it (None: at the end)
    """

    attributes: dict[str, str] = field(default_factory=dict)
    content: list[tuple[Element | None, str]] = field(default_factory=list)


@dataclass_transform(kw_only_default=True, eq_default=False)
class Element:
    """Any object of an AMALTHEA model.

    Objects are equal only to themselves. An object has at most one container: adding it to a second one removes it from the
    first.
    """

    __slots__ = ("_container", "_document", "_reference")

    _container: Element | None

    is_abstract: ClassVar[bool] = True
    is_referable: ClassVar[bool] = False

    def __init_subclass__(cls, abstract: bool = False) -> None:
        """Note of a new class whether it can have objects and whether these can be referred to."""
        cls.is_abstract = abstract
        cls.is_referable = any(base.__name__ == "IReferable" for base in cls.__mro__)

    def __new__(cls, *_args: Any, **_features: Any) -> Self:
        """A detached object, whatever is set."""
        self = object.__new__(cls)
        _set(self, "_container", None)
        return self

    def __init__(self, **features: Any) -> None:
        if self.is_abstract:
            raise TypeError(f"{type(self).__name__} is abstract; create an object of one of its subclasses")
        known, own = features_of(type(self)), self.__dict__
        for name, value in features.items():
            feature = known.get(name)
            if feature is not None and feature.kind == "attribute":
                own[name] = value  # nothing to mark as modified: the object is new
            else:
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
                    detach(old)
                if value is not None and feature.contains(value):
                    attach(self, value)
            _set(self, name, value)
            mark_modified(self, renames=name in _NAMING)

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
            f"{self!r} cannot be pickled or copied without its parts; use copy.deepcopy, or save and load the model"
        )

    def __repr__(self) -> str:
        from amalthea_uros.metamodel.summary import representation

        return representation(self)

    def __dir__(self) -> list[str]:
        return sorted({*object.__dir__(self), *features_of(type(self))})

    @property
    def container(self) -> Element | None:
        """The object that this one is part of; None for a root, an unresolved or a detached object."""
        return self._container

    @property
    def document(self) -> Document | None:
        """The document that contains this object; None while it is detached."""
        top: Element = self
        while top._container is not None:
            top = top._container
        return getattr(top, "_document", None)

    @property
    def model(self) -> Model | None:
        """The model that contains this object."""
        document = self.document
        return document.model if document else None

    @property
    def unresolved(self) -> str | None:
        """The text of the reference for which no object was found; None for every real object.

        An unresolved reference, also one into a file that was not loaded, refers to such a proxy of the right class.
        """
        return getattr(self, "_reference", None)

    @property
    def extras(self) -> Extras | None:
        """Content of the object in its file that is unknown to the metamodel, None if there is none. It may be modified."""
        found: Extras | None = self.__dict__.get("_extras")
        if found is not None:
            mark_modified(self)
        return found

    @property
    def unique_name(self) -> str:
        """The id under which references find this object, e.g. `Board/eth0?type=HwPort`."""
        from amalthea_uros.metamodel.naming import unique_name

        return unique_name(self)

    @property
    def qualified_name(self) -> str:
        """The name with the names that qualify it, joined by `.`; for an unnamed object its path."""
        from amalthea_uros.metamodel.naming import qualified_name

        return qualified_name(self)

    def effective(self, feature_name: str) -> Any:
        """The value of a feature, or its default in the AMALTHEA version of the object's document.

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
        """The nearest container of a class (such as the Task that contains a call), None if there is none."""
        element = self._container
        while element is not None and not isinstance(element, cls):
            element = element._container
        return element


def extras_of(element: Element) -> Extras:
    """The extras of an object, created if there are none."""
    found: Extras = element.__dict__.setdefault("_extras", Extras())
    return found


def extras_if_any(element: Element) -> Extras | None:
    """The extras of an object for reading only: unlike `Element.extras`, this does not mark the object as modified."""
    found: Extras | None = element.__dict__.get("_extras")
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
    near = did_you_mean(name, features_of(cls))
    return f"{cls.__name__} has no feature {name!r}{f', {near}' if near else ''}"
