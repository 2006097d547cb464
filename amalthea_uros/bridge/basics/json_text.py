"""Values of perf as JSON, for what a modelling language has no class for: fields with their defaults are left out.

Values are dataclasses, enumerations, texts, whole numbers, truth values, None, and tuples and sets of these.
"""

from __future__ import annotations

import json
import re
from dataclasses import MISSING, fields, is_dataclass
from enum import StrEnum
from fractions import Fraction
from math import isfinite
from types import NoneType, UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

from amalthea_uros.errors import UnknownError

T = TypeVar("T")

#: The key for the class of an object.
TAG = "class"

#: Whole numbers fit into 64 bits, as those of descriptions do.
_LIMIT = 2**63

#: A text of this length is no property that was built.
_LONGEST = 10_000_000


def to_text(value: Any, *, without: tuple[str, ...] = ()) -> str:
    """A value as JSON in one line.

    Parameters
    ----------
    without : fields that are known otherwise
    """
    content = {key: item for key, item in plain_value(value).items() if key not in without}
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


def plain_value(value: Any, *, tagged: bool = False) -> Any:
    """A value as JSON can hold it.

    Parameters
    ----------
    tagged : with the class of each object, which distinguishes alternatives with the same fields
    """
    if is_dataclass(value):
        stated = ((each.name, getattr(value, each.name), each) for each in fields(value) if each.compare)
        content = {name: plain_value(item, tagged=tagged) for name, item, each in stated if item != default_value(each)}
        return {TAG: type(value).__name__, **content} if tagged else content
    if isinstance(value, Fraction):
        return str(value)
    if isinstance(value, frozenset):
        return sorted(plain_value(item, tagged=tagged) for item in value)
    return [plain_value(item, tagged=tagged) for item in value] if isinstance(value, tuple) else value


def default_value(field: Any) -> Any:
    """The default of a field of a dataclass; MISSING without."""
    return field.default_factory() if field.default_factory is not MISSING else field.default


def _of_dataclass(kind: type[Any], content: Any, known: dict[str, Any]) -> Any:
    if not isinstance(content, dict):
        raise UnknownError(f"{kind.__name__} is not an object")
    content = {name: item for name, item in content.items() if name != TAG}
    declared = {each.name: each for each in fields(kind) if each.compare and each.name not in known}
    if unknown := sorted(content.keys() - declared.keys()):
        raise UnknownError(f"{kind.__name__} has no {unknown[0]!r}")
    missing = [name for name, each in declared.items() if name not in content and default_value(each) is MISSING]
    if missing:
        raise UnknownError(f"{kind.__name__} needs {missing[0]!r}")
    hints = get_type_hints(kind)
    return kind(**known, **{name: typed_value(hints[name], item, f"{kind.__name__}.{name}") for name, item in content.items()})


def typed_value(hint: Any, content: Any, where: str) -> Any:
    """The value of a type that JSON holds.

    Raises
    ------
    UnknownError : it is not one of that type.
    """
    origin, arguments = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        return None if content is None else typed_value(_alternative(arguments, content, where), content, where)
    if origin in (tuple, frozenset):
        return _several(origin, arguments, content, where)
    kind: Any = origin or hint
    if is_dataclass(kind):
        return _of_dataclass(kind, content, {})  # type: ignore[arg-type]
    if isinstance(kind, TypeVar):
        if type(content) not in (int, float) or not isfinite(content):
            raise UnknownError(f"{where} is not a number")
        return content
    if kind is Fraction:
        return _fraction(content, where)
    if issubclass(kind, StrEnum):
        if content not in list(kind):
            raise UnknownError(f"{content!r} is not a value of {where}")
        return kind(content)
    if type(content) is not kind or (kind is float and not isfinite(content)):
        raise UnknownError(f"{where} is not of type {kind.__name__}")
    if kind is int and abs(content) >= _LIMIT:
        raise UnknownError(f"{where} is out of range")
    return content


def _alternative(arguments: tuple[Any, ...], content: Any, where: str) -> Any:
    """The one of several types that a value has: by its tag, or by its type; otherwise the first one."""
    kinds = [argument for argument in arguments if argument is not NoneType]
    if isinstance(content, dict) and TAG in content:
        matching = [kind for kind in kinds if (get_origin(kind) or kind).__name__ == content[TAG]]
        if not matching:
            raise UnknownError(f"{content[TAG]!r} is none of the classes of {where}")
        return matching[0]
    return next((kind for kind in kinds if kind is type(content)), kinds[0])


def _several(origin: Any, arguments: tuple[Any, ...], content: Any, where: str) -> Any:
    if not isinstance(content, list):
        raise UnknownError(f"{where} is not a list")
    if origin is frozenset or arguments[-1] is ...:
        return origin(typed_value(arguments[0], item, where) for item in content)
    if len(content) != len(arguments):
        raise UnknownError(f"{where} has not {len(arguments)} values")
    return tuple(typed_value(argument, item, where) for argument, item in zip(arguments, content, strict=True))


def _fraction(content: Any, where: str) -> Fraction:
    # Without an exponent, which could make a number of any length.
    if isinstance(content, str) and re.fullmatch(r"-?\d{1,40}(/[1-9]\d{0,39})?", content):
        return Fraction(content)
    raise UnknownError(f"{where} is not a number")
