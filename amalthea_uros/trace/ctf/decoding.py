"""Decodes the fields of CTF: bit by bit where it must be, whole structures at once where all of their fields have fixed places."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from amalthea_uros.trace.ctf.types import (
    ArrayType,
    EnumerationType,
    FieldType,
    FloatType,
    IntegerType,
    StringType,
    StructType,
    VariantType,
)
from amalthea_uros.trace.files import UnreadableError

if TYPE_CHECKING:
    from mmap import mmap

Value: TypeAlias = Any
Fields: TypeAlias = dict[str, Any]

#: The depth of values in each other, and so many of them without a bit of the file are decoded for one event at most.
_DEPTH = 40
_FREE_STEPS = 4096
_CODES = {8: "b", 16: "h", 32: "i", 64: "q"}


class _Plan(NamedTuple):
    """How to take a structure at once.

    Attributes
    ----------
    texts : the places of values that are text
    stamps : the places of values that clocks show, with their types
    """

    layout: struct.Struct
    names: tuple[str, ...]
    texts: tuple[int, ...]
    stamps: tuple[tuple[int, IntegerType], ...]


class Decoder:
    """Takes values from a packet, one after the other.

    Attributes
    ----------
    data : the file
    position, end : in bits of the file
    stamps : values that clocks show, with their types, since the list was cleared
    """

    def __init__(self, data: mmap | bytes) -> None:
        self.position = self.end = 0
        self.stamps: list[tuple[int, IntegerType]] = []
        self.data = data
        self._start = 0
        self._scopes: list[Fields] = []
        self._steps = 0
        self._begin = 0
        # By the identity of the type, which the metadata keep, and by the place relative to its alignment.
        self._plans: dict[tuple[int, int], _Plan | None] = {}
        self._labels: dict[tuple[int, int], str] = {}

    def start_packet(self, start: int, end: int) -> None:
        """Begin with a packet, to which alignments are relative."""
        self._start = self.position = start
        self.end = end

    def start_event(self) -> None:
        """Begin with an event: nothing decoded before counts."""
        self._scopes.clear()
        self._steps, self._begin = 0, self.position

    def structure(self, kind: StructType | None) -> Fields:
        """The next structure, of which later ones can name fields; nothing if there is none.

        Raises
        ------
        UnreadableError : the bits do not fit.
        """
        if kind is None:
            return {}
        self._align(kind.align)
        key = id(kind), (self.position - self._start) % kind.align
        plan = self._plans.get(key, _MISSING)
        if plan is _MISSING:
            plan = self._plans[key] = _plan(kind, key[1]) if kind.align >= 8 or self.position % 8 == 0 else None
        fields = self._planned(plan) if isinstance(plan, _Plan) and self.position % 8 == 0 else self._struct(kind, 0)
        self._scopes.append(fields)
        return fields

    def _planned(self, plan: _Plan) -> Fields:
        end = self.position + plan.layout.size * 8
        if end > self.end:
            raise UnreadableError("the packet ends within an event", is_cut=True)
        values: Sequence[Value] = plan.layout.unpack_from(self.data, self.position >> 3)
        self.position = end
        if plan.texts:
            values = list(values)
            for place in plan.texts:
                values[place] = _text(values[place])
        for place, kind in plan.stamps:
            self.stamps.append((values[place], kind))
        return dict(zip(plan.names, values, strict=True))

    def _align(self, alignment: int) -> None:
        self.position += (self._start - self.position) % alignment

    def _value(self, kind: FieldType, depth: int) -> Value:
        self._steps += 1
        if depth > _DEPTH or self._steps > _FREE_STEPS + self.position - self._begin:
            raise UnreadableError("an event has too many fields in each other")
        match kind:
            case IntegerType():
                return self._integer(kind)
            case EnumerationType():
                return self._integer(kind.container)
            case FloatType():
                return self._float(kind)
            case StringType():
                return self._string()
            case ArrayType():
                return self._array(kind, depth)
            case StructType():
                return self._struct(kind, depth)
            case VariantType():
                return self._value(self._option(kind), depth + 1)

    def _integer(self, kind: IntegerType) -> int:
        self._align(kind.align)
        first, size = self.position, kind.size
        last = first + size
        if last > self.end:
            raise UnreadableError("the packet ends within an event", is_cut=True)
        self.position = last
        octets = self.data[first >> 3 : (last + 7) >> 3]
        value = int.from_bytes(octets, "big" if kind.is_big_endian else "little")
        value >>= len(octets) * 8 - (first & 7) - size if kind.is_big_endian else first & 7
        value &= (1 << size) - 1
        if kind.is_signed and value >> (size - 1):
            value -= 1 << size
        if kind.clock:
            self.stamps.append((value, kind))
        return value

    def _octets(self, number: int) -> bytes:
        """Some bytes at the next whole one."""
        self._align(8)
        first = self.position >> 3
        if number > (self.end >> 3) - first:
            raise UnreadableError("the packet ends within an event", is_cut=True)
        self.position += number * 8
        return bytes(self.data[first : first + number])

    def _float(self, kind: FloatType) -> float:
        self._align(kind.align)
        value: float = struct.unpack(
            (">" if kind.is_big_endian else "<") + ("f" if kind.size == 32 else "d"), self._octets(kind.size // 8)
        )[0]
        return value

    def _string(self) -> str:
        self._align(8)
        first = self.position >> 3
        last = self.data.find(b"\0", first, self.end >> 3)
        if last < 0:
            raise UnreadableError("the packet ends within a text", is_cut=True)
        text = self._octets(last + 1 - first)
        return _text(text)

    def _array(self, kind: ArrayType, depth: int) -> Value:
        length = kind.length if isinstance(kind.length, int) else self._named(kind.length)
        if not isinstance(length, int) or length < 0:
            raise UnreadableError("the length of a sequence is not a number")
        element = kind.element
        if isinstance(element, IntegerType) and element.is_text:
            self._align(element.align)
            return _text(self._octets(length))
        self._align(element.align)
        values = []
        for _ in range(length):
            values.append(self._value(element, depth + 1))
        return values

    def _struct(self, kind: StructType, depth: int) -> Fields:
        self._align(kind.align)
        fields: Fields = {}
        self._scopes.append(fields)
        for name, each in kind.fields:
            fields[name] = self._value(each, depth + 1)
            if isinstance(each, EnumerationType):
                fields[f"{name}\0"] = each
        self._scopes.pop()
        return fields

    def _option(self, kind: VariantType) -> FieldType:
        value, enumeration = self._named(kind.tag), self._named(kind.tag, "\0")
        if isinstance(enumeration, EnumerationType) and isinstance(value, int):
            key = id(enumeration), value
            if key not in self._labels and len(self._labels) < 1 << 16:
                self._labels[key] = enumeration.label(value)
            label = self._labels.get(key, "")
            option = kind.options.get(label.removeprefix("_")) if label else None
            if option is not None:
                return option
        raise UnreadableError("no option of a variant is selected")

    def _named(self, reference: str, suffix: str = "") -> Value:
        """The value of a field by its name, which may come after those of the structures around it."""
        name = reference.rpartition(".")[2].removeprefix("_") + suffix
        return next((scope[name] for scope in reversed(self._scopes) if name in scope), None)


_MISSING: Any = object()


def _text(octets: bytes) -> str:
    return octets.partition(b"\0")[0].decode("utf-8", "replace")


def _plan(kind: StructType, phase: int) -> _Plan | None:
    """How to take a structure at a place relative to its alignment at once, None if its fields have no fixed places in whole bytes."""
    position, codes, orders = phase, "", set()
    names: list[str] = []
    texts: list[int] = []
    stamps: list[tuple[int, IntegerType]] = []
    for name, each in kind.fields:
        number = each.container if isinstance(each, EnumerationType) else each.element if isinstance(each, ArrayType) else each
        if (
            not isinstance(number, IntegerType)
            or number.size not in _CODES
            or number.align % 8
            or isinstance(each, EnumerationType)
        ):
            return None
        padding = -position % number.align
        if isinstance(each, ArrayType):
            if not number.is_text or not isinstance(each.length, int) or each.length > 1 << 16:
                return None
            texts.append(len(names))
            code, size = f"{each.length}s", 8 * each.length
        else:
            code, size = _CODES[number.size] if number.is_signed else _CODES[number.size].upper(), number.size
            if number.size > 8:
                orders.add(number.is_big_endian)
            if number.clock:
                stamps.append((len(names), number))
        codes += f"{padding // 8}x{code}" if padding else code
        names.append(name)
        position += padding + size
    if len(orders) > 1 or not names or len(set(names)) < len(names):
        return None
    layout = struct.Struct((">" if True in orders else "<") + codes)
    return _Plan(layout, tuple(names), tuple(texts), tuple(stamps))
