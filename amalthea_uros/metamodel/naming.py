"""Names of objects: the unique name (the id in files) and the qualified name (for messages and look-up).

The unique name is that of APP4MC: segments in Java's form encoding, joined by `/`, then `?type=` and the class. Most objects have
one segment, their name; the exceptions are listed in `_PREFIXES`, and members of a namespace carry its segments in front.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from urllib.parse import quote_plus, unquote_plus

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.containment import ContainmentList
from amalthea_uros.metamodel.element import Element

NO_NAME = "no-name"
TYPE_MARK = "?type="

_PLAIN = re.compile(r"[A-Za-z0-9._*-]+").fullmatch


class _Encoded(dict[int, str]):
    """The encoding of each character of a unique name: to encode a whole name anew takes three times as long."""

    def __missing__(self, character: int) -> str:
        # quote_plus also leaves the tilde alone, Java does not.
        text = self[character] = quote_plus(chr(character), safe="*", errors="surrogatepass").replace("~", "%7E")
        return text


_ENCODED = _Encoded()


def encode(name: str | None) -> str:
    """One segment of a unique name, as `java.net.URLEncoder` writes it.

    >>> encode("E/E System")
    'E%2FE+System'
    """
    if not name:
        return NO_NAME
    # Most names are identifiers, which is found out in a third of the time.
    is_plain = (name.isascii() and name.isidentifier()) or _PLAIN(name)
    return name if is_plain else name.translate(_ENCODED)


def decode(segment: str) -> str:
    """The name that one segment of a unique name encodes."""
    return unquote_plus(segment)


def name_of(element: Element | None) -> str:
    """The raw name of an object, "" if it has none."""
    name = getattr(element, "name", None)
    return name if isinstance(name, str) else ""


def unique_name(element: Element) -> str:
    """The id of a referable object; the verbatim reference text for an unresolved one."""
    if element.unresolved is not None:
        return element.unresolved
    return "/".join(map(encode, segments(element))) + TYPE_MARK + type(element).__name__


def segments(element: Element) -> list[str]:
    """The raw names that make an object unique among those of its class."""
    if element.unresolved is not None:
        return [decode(segment) for segment in element.unresolved.partition(TYPE_MARK)[0].split("/")]
    cls = type(element)
    prefix = _PREFIXES.get(cls)
    if prefix is not None:
        return [*prefix(element), name_of(element)]
    namespace = element.__dict__.get("namespace")
    if namespace is not None:
        return [*segments(namespace), name_of(element)]
    return [name_of(element)]


def has_prefix(cls: type[Element]) -> bool:
    """Whether names of that class start with those of other objects."""
    return cls in _PREFIXES


def qualified_name(element: Element) -> str:
    """A readable name: `Board.eth0`; for an object that cannot be referenced, its path: `Task1.activityGraph.items[2]`."""
    if element.is_referable:
        return ".".join(segment or NO_NAME for segment in segments(element))
    return place(element)


def place(element: Element) -> str:
    """The path of an object from the nearest referable object on: `Task1.activityGraph.items[2]`."""
    steps: list[str] = []
    while not element.is_referable and element.container is not None:
        steps.append(_step(element.container, element))
        element = element.container
    start = qualified_name(element) if element.is_referable else type(element).__name__
    return ".".join([start, *reversed(steps)])


def _step(holder: Element, part: Element) -> str:
    from amalthea_uros.metamodel.features import containments_of

    lists: list[tuple[str, ContainmentList[Element]]] = []
    for feature in containments_of(type(holder)):
        held = holder.__dict__.get(feature.name)
        if held is part:
            return feature.xml_name
        if feature.many and held:
            lists.append((feature.xml_name, held))
    # No list is looked through again as long as another one knows the part.
    for find in (ContainmentList.known_place, ContainmentList.place_of):
        for name, parts in lists:
            if (index := find(parts, part)) is not None:
                return f"{name}[{index}]"
    raise ValueError(f"{part!r} is not a part of {holder!r}")


def _container_name(element: Element) -> list[str]:
    """One level only: neither the container's own prefix nor its containers."""
    holder = element.container
    return [name_of(holder)] if isinstance(holder, am.INamed) else []


def _container_segments(*classes: type[Element]) -> Callable[[Element], list[str]]:
    def prefix(element: Element) -> list[str]:
        holder = element.container
        return segments(holder) if isinstance(holder, classes) else []

    return prefix


def _call_argument_prefix(element: Element) -> list[str]:
    holder = element.enclosing(am.Runnable) or element.enclosing(am.Process)
    call = element.container
    called = call.runnable if isinstance(call, am.RunnableCall) else None
    parameter = element.parameter if isinstance(element, am.CallArgument) else None
    return [
        *(segments(holder) if holder else []),
        "calls",
        *(segments(called) if called else []),
        "param",
        name_of(parameter),
    ]


_PREFIXES: dict[type[Element], Callable[[Element], list[str]]] = {
    am.HwFeature: _container_name,
    am.HwPort: _container_name,
    am.HwConnection: _container_name,
    am.ComponentInstance: _container_name,
    am.ModeLiteral: _container_name,
    am.ComponentPort: _container_segments(am.Component),
    am.SubInterface: _container_segments(Element),
    am.ComponentStructure: _container_segments(am.ComponentStructure),
    am.Namespace: _container_segments(am.Namespace),
    am.RunnableParameter: _container_segments(am.Runnable),
    am.LocalModeLabel: _container_segments(am.Process, am.Runnable),
    am.CallArgument: _call_argument_prefix,
}
