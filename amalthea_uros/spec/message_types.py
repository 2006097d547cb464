"""Sizes of messages that follow from their types."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeAlias

from amalthea_uros.spec.fields import After
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.spec.values import Count, editor_schema, problem, unexpected
from amalthea_uros.units import parse_data_size

if TYPE_CHECKING:
    from amalthea_uros._internal.message_types import Length, LengthBounds

_TYPE = re.compile(r"[a-z]\w*/(msg|srv|action)/[A-Z]\w*", re.ASCII)
_EXAMPLE = "std_msgs/msg/Int32"


def _is_type(value: str) -> str:
    if _TYPE.fullmatch(value) is None:
        raise unexpected(f"expected a type such as {_EXAMPLE!r}")
    return value


#: The full name of a type of messages, services or actions.
TypeName: TypeAlias = Annotated[
    str,
    After(_is_type),
    editor_schema(f"expected a type such as {_EXAMPLE}", type="string", pattern=f"^{_TYPE.pattern}$", examples=[_EXAMPLE]),
]


class BoundsSection(DescriptionSection):
    """The longest strings and sequences of a message, where its type does not bound them."""

    string: Count | None = None
    """Characters of the longest string, without the byte at its end."""
    sequence: Count | None = None
    """Elements of the longest sequence."""


class TypedMessage(DescriptionSection):
    """A section with messages of a type, from which their sizes follow if they are not stated.

    Attributes
    ----------
    sizes : keys of the sizes -> the parts of the type
    """

    sizes: ClassVar[Mapping[str, str]] = {"message_size": ""}

    type: TypeName | None = None
    """Type of its messages, e.g. `std_msgs/msg/Int32`."""
    bounds: BoundsSection | None = None
    """Longest strings and sequences of a message, where the type does not bound them."""

    @classmethod
    def _prepared(cls, value: Any) -> Any:
        return cls._with_sizes(super()._prepared(value))

    @classmethod
    def _with_sizes(cls, value: Any) -> Any:
        kind = value.get("type") if isinstance(value, dict) else None
        if not isinstance(kind, str) or _TYPE.fullmatch(kind) is None:
            return value
        from amalthea_uros._internal.message_types import LengthBounds

        given = value.get("bounds")
        stated = given if isinstance(given, dict) else {}
        # What is no number is reported where it is.
        bounds = LengthBounds(**{part: _count(stated[part]) for part in LengthBounds._fields if part in stated})
        derived = {key: _size(kind, part, value.get(key), bounds) for key, part in cls.sizes.items()}
        return value | {key: size for key, size in derived.items() if size is not None}

    @classmethod
    def implied_keys(cls) -> Mapping[str, Sequence[str]]:
        """The sizes follow from the type."""
        return {"type": list(cls.sizes)}


def _count(value: Any) -> int:
    return value if isinstance(value, int) and not isinstance(value, bool) and 0 < value <= 1_000_000 else 1


def _size(kind: str, part: str, stated: Any, bounds: LengthBounds) -> str | None:
    """The size that follows from a type; None if it is stated, or the type is not known."""
    from amalthea_uros._internal.message_types import MessageType, length_of, unbounded_parts

    whole = MessageType(*kind.split("/"))
    own = whole.part(part) if part else whole
    length = length_of(own, bounds=bounds)
    if stated is not None:
        _check(stated, kind, length)
        return None
    if length is None:
        return None
    if length.most is None:
        missing = [each for each in unbounded_parts(own) if getattr(bounds, each) is None]
        raise problem(
            f"{kind} has no longest {' and no longest '.join(missing)}: state it in 'bounds', e.g. {missing[0]}: 20, or the size"
        )
    return f"{length.most} B"


def _check(stated: Any, kind: str, length: Length | None) -> None:
    """Refuse a size that no message of the type can have."""
    try:
        size = parse_data_size(str(stated))
    except ValueError:
        return
    if length is not None and size < 8 * length.bytes:
        raise problem(f"the size {stated} is less than the {length.bytes} B of the shortest message of {kind}")
