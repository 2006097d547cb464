"""Parts and references of objects: lists that know their owner, and attaching and detaching of objects."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Self, SupportsIndex, TypeVar

if TYPE_CHECKING:
    from amalthea_uros.metamodel.element import Element
    from amalthea_uros.metamodel.model import Document

E = TypeVar("E", bound="Element")
_NO_PLACES: Mapping[Element, int] = MappingProxyType({})

_set = object.__setattr__


class Revision:
    """Counts the changes of names and containment in this process; look-up tables of an earlier revision are stale."""

    number: ClassVar[int] = 0


class ReferenceList(list[E]):
    """References of one object, in order; every change marks the object as modified."""

    __slots__ = ("_owner",)

    def __init__(self, owner: Element, values: Iterable[E] = ()) -> None:
        super().__init__(values)
        self._owner = owner

    def append(self, value: E) -> None:
        super().append(value)
        mark_modified(self._owner)

    def insert(self, index: SupportsIndex, value: E) -> None:
        super().insert(index, value)
        mark_modified(self._owner)

    def extend(self, values: Iterable[E]) -> None:
        super().extend(values)
        mark_modified(self._owner)

    def __iadd__(self, values: Iterable[E]) -> Self:  # type: ignore[override, misc]
        self.extend(values)
        return self

    def __imul__(self, times: SupportsIndex) -> Self:
        super().__imul__(times)
        mark_modified(self._owner)
        return self

    def __setitem__(self, index: Any, value: Any) -> None:
        super().__setitem__(index, value)
        mark_modified(self._owner)

    def __delitem__(self, index: Any) -> None:
        super().__delitem__(index)
        mark_modified(self._owner)

    def remove(self, value: E) -> None:
        super().remove(value)
        mark_modified(self._owner)

    def pop(self, index: SupportsIndex = -1) -> E:
        value = super().pop(index)
        mark_modified(self._owner)
        return value

    def clear(self) -> None:
        super().clear()
        mark_modified(self._owner)

    def sort(self, *, key: Any = None, reverse: bool = False) -> None:
        super().sort(key=key, reverse=reverse)
        mark_modified(self._owner)

    def reverse(self) -> None:
        super().reverse()
        mark_modified(self._owner)

    def __reduce__(self) -> tuple[Any, ...]:
        return (list, (list(self),))


class ContainmentList(ReferenceList[E]):
    """Parts of one object, in order. Adding an object makes the owner its container."""

    __slots__ = ("_places",)

    def __init__(self, owner: Element, values: Iterable[E] = ()) -> None:
        super().__init__(owner)
        for value in values:
            self.append(value)

    def known_place(self, value: E) -> int | None:
        """The index of a part if it is known from before; that takes no time."""
        # The reader makes lists without their constructor, so that there are no places at first.
        place = getattr(self, "_places", _NO_PLACES).get(value)
        return place if place is not None and place < len(self) and self[place] is value else None

    def place_of(self, value: E) -> int | None:
        """The index of a part; None if it is not one. Asking for all parts takes time in proportion to their number."""
        place = self.known_place(value)
        if place is None:
            self._places = {part: index for index, part in enumerate(self)}
            place = self._places.get(value)
        return place

    def append(self, value: E) -> None:
        attach(self._owner, value)
        super().append(value)

    def insert(self, index: SupportsIndex, value: E) -> None:
        attach(self._owner, value)
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
            detach(value)
        super().__delitem__(index)

    def remove(self, value: E) -> None:
        del self[self.index(value)]

    def pop(self, index: SupportsIndex = -1) -> E:
        detach(self[index])
        return super().pop(index)

    def clear(self) -> None:
        del self[:]


def mark_modified(element: Element, renames: bool = False) -> Document | None:
    """Mark an object as modified, and as renamed if references to it or to its parts may be affected."""
    path = path_of(element)
    if renames:
        Revision.number += 1
    document: Document | None = getattr(path[-1], "_document", None)
    if document is not None:
        document.changes.note(path, renames)
    return document


def path_of(element: Element) -> list[Element]:
    """The object, its container, and so on up to the root."""
    path = [element]
    while (holder := path[-1]._container) is not None:
        path.append(holder)
    return path


def detach(value: Element) -> None:
    """Detach an object from its container, before it is removed from it."""
    document = mark_modified(value, renames=True)
    if document is not None and document.source is not None:
        # Changes of a detached object are not recorded; if it comes back, all of it is compared with the source.
        document.changes.modified.update(value.walk())
    _set(value, "_container", None)


def attach(owner: Element, value: Element) -> None:
    """Make `owner` the container of `value`, and remove it from the old one."""
    if not hasattr(value, "_container"):
        raise TypeError(f"{owner!r} cannot contain {value!r}: not a model object")
    ancestor: Element | None = owner
    while ancestor is not None:
        if ancestor is value:
            raise ValueError(f"{value!r} cannot become a part of {owner!r}, which is part of it")
        ancestor = ancestor._container
    _take_out(value)
    _set(value, "_container", owner)
    mark_modified(value, renames=True)


def _take_out(value: Element) -> None:
    from amalthea_uros.metamodel.features import containments_of  # the features need the lists of this module

    holder = value._container
    if holder is None:
        return
    for feature in containments_of(type(holder)):
        held = holder.__dict__.get(feature.name)
        if held is value:
            detach(value)
            _set(holder, feature.name, None)
        elif feature.many and held and any(element is value for element in held):
            held.remove(value)
