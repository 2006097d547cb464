"""Values that a project has no class or feature for, as JSON in the comment of an object: other tools show it and leave it alone."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import fields
from typing import Any, TypeVar, get_type_hints

from amalthea_uros.bridge.basics.json_text import TAG, default_value, from_text, plain_value, typed_value
from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject

T = TypeVar("T")

_BEGIN = "amuros "


def keep_fields(item: ProjectObject, source: Any, names: Iterable[str]) -> tuple[str, ...]:
    """Keep fields in the comment that are not at their defaults; returns their names."""
    declared = {field.name: field for field in fields(source)}
    kept = [name for name in names if getattr(source, name) != default_value(declared[name])]
    note(item, **{name: plain_value(getattr(source, name), tagged=True) for name in kept})
    return tuple(kept)


def keep_whole(item: ProjectObject, key: str, source: Any) -> None:
    """Keep an object in the comment."""
    note(item, **{key: plain_value(source, tagged=True)})


def keep_list(item: ProjectObject, key: str, sources: Iterable[Any]) -> None:
    """Keep objects in the comment."""
    if result := [plain_value(source, tagged=True) for source in sources]:
        note(item, **{key: result})


def note(item: ProjectObject, **content: Any) -> None:
    """Add to the comment."""
    if content:
        text = json.dumps({**noted(item), **content}, ensure_ascii=False, separators=(",", ":"))
        item["comment"] = _BEGIN + text


def is_ours(item: ProjectObject) -> bool:
    """Whether an object has a comment of ours, maybe a damaged one."""
    return (item.values.get("comment") or "").startswith(_BEGIN)


def noted(item: ProjectObject) -> dict[str, Any]:
    """The content of a comment of ours; empty for any other comment.

    Raises
    ------
    UnknownError : it began as one of ours, and is damaged.
    """
    if not is_ours(item):
        return {}
    try:
        result = json.loads(item["comment"].removeprefix(_BEGIN))
    except (ValueError, RecursionError) as error:
        raise UnknownError(f"its comment is damaged: {error}") from None
    if not isinstance(result, dict):
        raise UnknownError("its comment is damaged: it is not an object")
    return result


def kept_fields(item: ProjectObject, kind: type[Any], names: Iterable[str]) -> dict[str, Any]:
    """The values of the fields of a class that the comment keeps.

    Raises
    ------
    UnknownError : one of them is damaged.
    """
    content = noted(item)
    present = [name for name in names if name in content]
    if not present:
        return {}
    hints = get_type_hints(kind)
    return {name: typed_value(hints[name], content[name], f"{kind.__name__}.{name}") for name in present}


def kept_whole(item: ProjectObject, key: str, kinds: Iterable[type[T]], **known: Any) -> T | None:
    """The object of one of some classes that the comment keeps under a key; None if there is none.

    Raises
    ------
    UnknownError : it is damaged.
    """
    content = noted(item).get(key)
    return None if content is None else whole(content, kinds, **known)


def whole(content: Any, kinds: Iterable[type[T]], **known: Any) -> T:
    """An object of one of some classes; raises as `kept_whole`."""
    kind = next((kind for kind in kinds if isinstance(content, dict) and kind.__name__ == content.get(TAG)), None)
    if kind is None:
        raise UnknownError("its comment has no object of a known class")
    return from_text(kind, json.dumps(content), **known)
