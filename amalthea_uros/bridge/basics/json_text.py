"""Values of perf as JSON, for what AMALTHEA has no class for: fields with their defaults are left out.

Values are dataclasses, enumerations, texts, whole numbers, truth values, None, and tuples and sets of these.
"""

from __future__ import annotations

import json
from dataclasses import MISSING, fields, is_dataclass
from enum import StrEnum
from types import NoneType, UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

from amalthea_uros.errors import UnknownError

T = TypeVar("T")

#: A text of this length is no property that was built.
_LONGEST = 10_000_000


def to_text(value: Any, *, without: tuple[str, ...] = ()) -> str:
    """A value as JSON in one line.

    Parameters
    ----------
    without : fields that are known otherwise
    """
    content = {key: item for key, item in _plain(value).items() if key not in without}
    return json.dumps(content, ensure_ascii=False, separators=(",", ":"))


def from_text(kind: type[T], text: str, **known: Any) -> T:
    """The value of a JSON text.

    Parameters
    ----------
    known : fields that are not in the text

    Raises
    ------
    UnknownError : the text is not that of a value of the kind.
    """
    if len(text) > _LONGEST:
        raise UnknownError("the text is too long")
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise UnknownError(f"not valid JSON: {error}") from None
    found: T = _of_dataclass(kind, content, known)
    return found


def _plain(value: Any) -> Any:
    if is_dataclass(value):
        stated = ((each.name, getattr(value, each.name), each) for each in fields(value) if each.compare)
        return {name: _plain(item) for name, item, each in stated if item != _default(each)}
    if isinstance(value, frozenset):
        return sorted(map(_plain, value))
    return list(map(_plain, value)) if isinstance(value, tuple) else value


def _default(field: Any) -> Any:
    return field.default_factory() if field.default_factory is not MISSING else field.default


def _of_dataclass(kind: type[Any], content: Any, known: dict[str, Any]) -> Any:
    if not isinstance(content, dict):
        raise UnknownError(f"{kind.__name__} is not an object")
    declared = {each.name: each for each in fields(kind) if each.compare and each.name not in known}
    if unknown := sorted(content.keys() - declared.keys()):
        raise UnknownError(f"{kind.__name__} has no {unknown[0]!r}")
    missing = [name for name, each in declared.items() if name not in content and _default(each) is MISSING]
    if missing:
        raise UnknownError(f"{kind.__name__} needs {missing[0]!r}")
    hints = get_type_hints(kind)
    return kind(**known, **{name: _value(hints[name], item, f"{kind.__name__}.{name}") for name, item in content.items()})


def _value(hint: Any, content: Any, where: str) -> Any:
    origin, arguments = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        inner = [argument for argument in arguments if argument is not NoneType]
        return None if content is None else _value(inner[0], content, where)
    if origin in (tuple, frozenset):
        if not isinstance(content, list):
            raise UnknownError(f"{where} is not a list")
        return origin(_value(arguments[0], item, where) for item in content)
    if is_dataclass(hint):
        return _of_dataclass(hint, content, {})  # type: ignore[arg-type]
    if issubclass(hint, StrEnum):
        if content not in list(hint):
            raise UnknownError(f"{content!r} is not a value of {where}")
        return hint(content)
    if type(content) is not hint:
        raise UnknownError(f"{where} is not of type {hint.__name__}")
    return content
