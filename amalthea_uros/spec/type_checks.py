"""Checks of values against the types of keys; each returns the value to use, or adds to the errors."""

from __future__ import annotations

import types
from collections.abc import Callable, Sequence
from typing import Annotated, Any, Literal, NotRequired, TypeAlias, TypedDict, Union, get_args, get_origin

from amalthea_uros.spec.fields import After, Before, Limits

#: Keys, and positions in lists, from the whole document to a value.
Path: TypeAlias = tuple[int | str, ...]
#: In place of a value that is not right.
WRONG: Any = object()


class ErrorDetails(TypedDict):
    """An error in a section.

    Attributes
    ----------
    type : what kind of error it is
    ctx : what the message says about it
    """

    type: str
    loc: Path
    msg: str
    input: Any
    ctx: NotRequired[dict[str, Any]]


Errors: TypeAlias = list[ErrorDetails]
Check: TypeAlias = Callable[[Any, Path, Errors], Any]


class WrongValueError(ValueError):
    """A wrong value.

    Attributes
    ----------
    kind : type of the error
    """

    def __init__(self, kind: str, message: str) -> None:
        super().__init__(message)
        self.kind = kind


def wrong(errors: Errors, kind: str, loc: Path, value: Any, message: str, **context: Any) -> Any:
    """Add an error."""
    details = ErrorDetails(type=kind, loc=loc, msg=message, input=value)
    if context:
        details["ctx"] = context
    errors.append(details)
    return WRONG


def check_of(annotation: Any, marks: Sequence[Any] = ()) -> Check:
    """The check of a type with further marks."""
    check = _check_of(annotation)
    for mark in marks:
        check = _marked(check, mark)
    return check


def _check_of(annotation: Any) -> Check:
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return check_of(parts[0], parts[1:])
    if origin is Literal:
        return _choice(parts)
    if origin is list:
        return _list(check_of(parts[0]))
    if origin is dict:
        return _mapping(check_of(parts[0]), check_of(parts[1]))
    if origin in (Union, types.UnionType):
        # Keys without a value are refused before; of other unions there are none.
        (only,) = (each for each in parts if each is not type(None))
        return check_of(only)
    if annotation in _OF_PLAIN_TYPES:
        return _OF_PLAIN_TYPES[annotation]
    return getattr(annotation, "checked", None) or _instance(annotation)


def _marked(check: Check, mark: Any) -> Check:
    match mark:
        case Before(convert):
            return lambda value, loc, errors: _converted(convert, check, value, loc, errors)
        case After(examine):
            return lambda value, loc, errors: _converted_after(examine, check(value, loc, errors), loc, errors)
        case Limits():
            return lambda value, loc, errors: _limited(mark, check(value, loc, errors), value, loc, errors)
    return check


def _converted(convert: Callable[[Any], Any], check: Check, value: Any, loc: Path, errors: Errors) -> Any:
    try:
        result = convert(value)
    except WrongValueError as problem:
        return wrong(errors, problem.kind, loc, value, str(problem))
    return check(result, loc, errors)


def _converted_after(examine: Callable[[Any], Any], value: Any, loc: Path, errors: Errors) -> Any:
    if value is WRONG:
        return WRONG
    try:
        return examine(value)
    except WrongValueError as problem:
        return wrong(errors, problem.kind, loc, value, str(problem))


def _limited(limits: Limits, result: Any, value: Any, loc: Path, errors: Errors) -> Any:
    if result is WRONG:
        return WRONG
    if limits.min_length is not None and len(result) < limits.min_length:
        return wrong(errors, "too_short", loc, value, "too short", min_length=limits.min_length, actual_length=len(result))
    if limits.max_length is not None and len(result) > limits.max_length:
        return wrong(errors, "too_long", loc, value, "too long", max_length=limits.max_length, actual_length=len(result))
    if limits.le is not None and result > limits.le:
        return wrong(errors, "less_than_equal", loc, value, "too large", le=limits.le)
    if limits.lt is not None and result >= limits.lt:
        return wrong(errors, "less_than", loc, value, "too large", lt=limits.lt)
    if limits.ge is not None and result < limits.ge:
        return wrong(errors, "greater_than_equal", loc, value, "too small", ge=limits.ge)
    if limits.gt is not None and result <= limits.gt:
        return wrong(errors, "greater_than", loc, value, "too small", gt=limits.gt)
    return result


def _choice(words: tuple[Any, ...]) -> Check:
    *others, last = map(repr, words)
    expected = f"{', '.join(others)} or {last}" if others else last

    def check(value: Any, loc: Path, errors: Errors) -> Any:
        result = next((word for word in words if type(word) is type(value) and word == value), WRONG)
        if result is WRONG:
            wrong(errors, "literal_error", loc, value, f"expected {expected}", expected=expected)
        return result

    return check


def _list(item: Check) -> Check:
    def check(value: Any, loc: Path, errors: Errors) -> Any:
        if not isinstance(value, list | tuple):
            return wrong(errors, "list_type", loc, value, "expected a list")
        result = [item(each, (*loc, index), errors) for index, each in enumerate(value)]
        return WRONG if any(each is WRONG for each in result) else result

    return check


def _mapping(name: Check, item: Check) -> Check:
    def check(value: Any, loc: Path, errors: Errors) -> Any:
        if not isinstance(value, dict):
            return wrong(errors, "dict_type", loc, value, "expected a mapping")
        pairs = [(name(key, (*loc, key, "[key]"), errors), item(each, (*loc, key), errors)) for key, each in value.items()]
        return WRONG if any(key is WRONG or each is WRONG for key, each in pairs) else dict(pairs)

    return check


def _whole(value: Any, loc: Path, errors: Errors) -> Any:
    if isinstance(value, int) and not isinstance(value, bool):
        return value
    return wrong(errors, "int_type", loc, value, "expected an integer")


def _real(value: Any, loc: Path, errors: Errors) -> Any:
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    return wrong(errors, "float_type", loc, value, "expected a number")


def _text(value: Any, loc: Path, errors: Errors) -> Any:
    return value if isinstance(value, str) else wrong(errors, "string_type", loc, value, "expected a string")


#: What else files may write for truth values, because versions of YAML differ in that.
_TRUTH = {"1": True, "on": True, "t": True, "true": True, "y": True, "yes": True} | {
    "0": False,
    "off": False,
    "f": False,
    "false": False,
    "n": False,
    "no": False,
}


def _truth(value: Any, loc: Path, errors: Errors) -> Any:
    if isinstance(value, bool):
        return value
    result = _TRUTH.get(str(value).lower(), WRONG) if isinstance(value, str | int) else WRONG
    return wrong(errors, "bool_type", loc, value, "expected true or false") if result is WRONG else result


def _instance(kind: Any) -> Check:
    def check(value: Any, loc: Path, errors: Errors) -> Any:
        return value if isinstance(value, kind) else wrong(errors, "is_instance_of", loc, value, f"expected {kind.__name__}")

    return check


_OF_PLAIN_TYPES: dict[Any, Check] = {
    int: _whole,
    float: _real,
    str: _text,
    bool: _truth,
    Any: lambda value, _loc, _errors: value,
}
