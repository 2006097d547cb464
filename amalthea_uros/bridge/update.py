"""Writes what differs between two systems into a model that was read, without modifying the rest of it.

Both systems are built as objects. Where those differ, the object of the model with the same name gets the new value; in an object
whose form in the model is another one, such as a time in another unit, all of the value is replaced.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from copy import deepcopy
from typing import Any

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros.bridge.basics.context import Extracting
from amalthea_uros.bridge.basics.kinds import kind_of
from amalthea_uros.bridge.build import build_model
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.features import ElementFeature, features_of
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.versions import version_key
from amalthea_uros.perf.system import System

#: Systems can be built as objects of this version and newer ones.
_OLDEST = "1.2.0"

#: The feature by which objects without a name are found again.
_IDENTIFYING: dict[type[Element], str] = {
    am.TaskAllocation: "task",
    am.ISRAllocation: "isr",
    am.SchedulerAllocation: "scheduler",
    am.MemoryMapping: "abstract_element",
    am.SchedulingParameter: "key",
    am.CustomProperty: "key",
}


#: The key of parts that are found by their position.
_POSITION = object()


def update(model: Model, old: System, new: System) -> None:
    """Write what differs between the system of a model and a changed one into the model.

    Parameters
    ----------
    old : what `extract` makes of the model

    Raises
    ------
    InvalidArgumentError : the model has no place for a difference. The model is then useless.
    WriteError : a system cannot be built as objects of the version of the model.
    """
    version = max(model.documents[0].facts_version, _OLDEST, key=version_key)
    with paused_garbage_collection():
        before, after = (build_model(system, version).root for system in (old, new))
        _Update(model).apply(_keyed(before, _built_key), _keyed(after, _built_key))


def _built_key(element: Element) -> Hashable:
    """What an object of a built model is found by; None for parts that only their holder knows."""
    return _key(element, element.__dict__.get("name"))


def _key(element: Element, name: str | None) -> Hashable:
    kind = kind_of(type(element))
    if kind is not None:
        return kind, name
    if isinstance(element.container, am.Amalthea):
        return type(element).__name__
    return (type(element).__name__, name) if element.is_referable and name else None


def _keyed(root: Element, key_of: Callable[[Element], Hashable]) -> dict[Hashable, Element]:
    return {key: element for element in root.walk() if (key := key_of(element)) is not None}


class _Update:
    """The state of one update."""

    def __init__(self, model: Model) -> None:
        naming = Extracting(model)
        naming.name()
        self._names = naming.names
        self._model = model
        self._targets: dict[Hashable, Element] = {}
        for document in model.documents:
            self._targets |= _keyed(document.root, self._model_key)

    def _model_key(self, element: Element) -> Hashable:
        return _key(element, self._names.get(element) or element.__dict__.get("name"))

    def apply(self, old: dict[Hashable, Element], new: dict[Hashable, Element]) -> None:
        """Add what is new, and then set what differs."""
        if lost := [key for key in old if key not in new]:
            raise InvalidArgumentError(f"{lost[0]} would have to be removed")
        for key, element in new.items():
            if key not in old and key not in self._targets:
                self._add(element)
        for key, element in new.items():
            if key in old and _meaning(old[key]) != _meaning(element):
                self._change(old[key], element, self._target(element))

    # Objects

    def _target(self, element: Element) -> Element:
        """The object of the model for one that was built; it is added if there is none."""
        key = _built_key(element)
        if key not in self._targets:
            self._add(element)
        return self._targets[key]

    def _add(self, element: Element) -> None:
        holder = element.container
        if holder is None:
            raise InvalidArgumentError(f"the model has no {type(element).__name__}")
        target = self._model.documents[-1].root if isinstance(holder, am.Amalthea) else self._target(holder)
        feature = next(f for f in features_of(type(holder)).values() if element in _parts(holder, f))
        if isinstance(holder, am.Amalthea):
            added: Element = type(element)()
        else:
            added = self._copy(element)
        if feature.many:
            getattr(target, feature.name).append(added)
        else:
            setattr(target, feature.name, added)
        self._targets[_built_key(element)] = added
        # An added operating system brings its schedulers and controllers with it.
        self._targets |= _keyed(added, _built_key)

    def _copy(self, element: Element) -> Element:
        """A copy that refers to objects of the model."""
        twin = deepcopy(element)
        for inner in twin.walk():
            for feature in features_of(type(inner)).values():
                if feature.kind == "attribute" or feature.name not in inner.__dict__:
                    continue
                if feature.many:
                    values = [value if feature.contains(value) else self._target(value) for value in _values(inner, feature)]
                    if any(not feature.contains(value) for value in values):
                        setattr(inner, feature.name, values)
                elif (value := inner.__dict__[feature.name]) is not None and not feature.contains(value):
                    setattr(inner, feature.name, self._target(value))
        return twin

    # Features

    def _change(self, old: Element, new: Element, target: Element) -> None:
        """Set the features of an object of the model that differ between two built ones."""
        if type(target) is not type(new):
            raise InvalidArgumentError(f"{_described(target)} would have to become a {type(new).__name__}")
        for feature in features_of(type(new)).values():
            before, after = _values(old, feature), _values(new, feature)
            if _meanings(feature, before) == _meanings(feature, after):
                continue
            if feature.kind == "attribute":
                setattr(target, feature.name, new.__dict__.get(feature.name))
            elif any(feature.contains(value) for value in (*before, *after)):
                self._change_parts(feature, _own(before), _own(after), target)
            else:
                self._change_references(feature, before, after, target)

    def _change_references(self, feature: ElementFeature, before: Sequence[Any], after: Sequence[Any], target: Element) -> None:
        """Set references; in a list that also has others, only those that differ."""
        old, new = ([self._target(value) for value in values] for values in (before, after))
        held = _values(target, feature)
        if len(held) != len(old):
            new = [value for value in held if value not in old or value in new] + [value for value in new if value not in held]
        setattr(target, feature.name, new if feature.many else next(iter(new), None))

    def _change_parts(
        self, feature: ElementFeature, before: Sequence[Element], after: Sequence[Element], target: Element
    ) -> None:
        """Change the parts that are on both sides, add and remove others."""
        held = _own(_values(target, feature))
        if not feature.many and not held:
            # What the model leaves open is a default, which the built object states.
            before = ()
        old, new = _identified(before, _built_key), _identified(after, _built_key)
        present = _identified(held, self._model_key)
        kept = dict.fromkeys(key for key in old if key in new and _meaning(old[key]) != _meaning(new[key]))
        is_positional = any(key[0] is _POSITION for key in kept)
        if (is_positional and len(held) != len(before)) or any(
            key not in present for key in (*kept, *(old.keys() - new.keys()))
        ):
            raise InvalidArgumentError(f"{_described(target)} states its {feature.xml_name} in another form")
        for key in old:
            if key not in new:
                self._replace(feature, target, present[key], None)
        for key, part in new.items():
            if key not in old:
                self._replace(feature, target, None, self._copy(part))
            elif key in kept:
                self._change_part(feature, target, old[key], part, present[key])

    def _change_part(self, feature: ElementFeature, target: Element, old: Element, new: Element, present: Element) -> None:
        if type(present) is not type(new) or type(old) is not type(new):
            self._replace(feature, target, present, self._copy(new))
        elif isinstance(new, am.Quantity | am.Value):
            for inner in features_of(type(new)).values():
                if present.__dict__.get(inner.name) != new.__dict__.get(inner.name):
                    setattr(present, inner.name, new.__dict__.get(inner.name))
        else:
            self._change(old, new, present)

    @staticmethod
    def _replace(feature: ElementFeature, target: Element, present: Element | None, new: Element | None) -> None:
        if not feature.many:
            setattr(target, feature.name, new)
            return
        held = getattr(target, feature.name)
        place = len(held) if present is None else held.index(present)
        if present is not None:
            del held[place]
        if new is not None:
            held.insert(place, new)


def _identified(parts: Iterable[Element], key_of: Callable[[Element], Hashable]) -> dict[tuple[Hashable, int], Element]:
    """Parts by the object or key that they are about, others by their position."""
    counts: Counter[Hashable] = Counter()
    found: dict[tuple[Hashable, int], Element] = {}
    for part in parts:
        feature = _IDENTIFYING.get(type(part))
        value = part.__dict__.get(feature) if feature else None
        key: Hashable = _POSITION if feature is None else (type(part), key_of(value) if isinstance(value, Element) else value)
        found[key, counts[key]] = part
        counts[key] += 1
    return found


def _values(element: Element, feature: ElementFeature) -> list[Any]:
    value = element.__dict__.get(feature.name)
    return [] if value is None else list(value) if feature.many else [value]


def _parts(element: Element, feature: ElementFeature) -> list[Any]:
    return [] if feature.kind == "attribute" else [value for value in _values(element, feature) if feature.contains(value)]


def _own(values: Iterable[Any]) -> list[Element]:
    """The parts that are not found by a name."""
    return [value for value in values if _built_key(value) is None]


def _meaning(element: Element) -> Hashable:
    """What an object states itself: without the objects in it that have names."""
    stated = ((f.name, _meanings(f, _values(element, f))) for f in features_of(type(element)).values())
    return type(element), tuple((name, meanings) for name, meanings in stated if meanings)


def _meanings(feature: ElementFeature, values: Iterable[Any]) -> Hashable:
    return tuple(_meaning_of_values(feature, values))


def _meaning_of_values(feature: ElementFeature, values: Iterable[Any]) -> Iterator[Hashable]:
    for value in values:
        if feature.kind == "attribute":
            yield type(value), value
        elif not feature.contains(value):
            yield _built_key(value)
        elif _built_key(value) is None:
            yield _meaning(value)


def _described(element: Element) -> str:
    """An object, or the nearest one with a name that contains it."""
    holder: Element | None = element
    while holder is not None and not holder.__dict__.get("name"):
        holder = holder.container
    where = f" of {holder.__dict__['name']!r}" if holder is not None and holder is not element else ""
    name = element.__dict__.get("name")
    return f"{type(element).__name__}{where}" + (f" {name!r}" if name else "")
