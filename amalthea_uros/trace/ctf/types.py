"""The types of fields of CTF 1.8 (specification, section 4)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass


@dataclass(frozen=True, slots=True)
class IntegerType:
    """A whole number.

    Attributes
    ----------
    size, align : bits
    is_text : whether arrays of it are text
    clock : the name of the clock that it shows, "" if none
    """

    size: int
    align: int = 1
    is_signed: bool = False
    is_big_endian: bool = False
    is_text: bool = False
    clock: str = ""


@dataclass(frozen=True, slots=True)
class FloatType:
    """A number of 32 or 64 bits (IEEE 754)."""

    size: int
    align: int = 1
    is_big_endian: bool = False


@dataclass(frozen=True, slots=True)
class EnumerationType:
    """A number with names for ranges of values: (first, last, name)."""

    container: IntegerType
    ranges: tuple[tuple[int, int, str], ...]

    @property
    def align(self) -> int:
        """That of its numbers."""
        return self.container.align

    def label(self, value: int) -> str:
        """The name of a value, "" if it has none."""
        return next((name for first, last, name in self.ranges if first <= value <= last), "")


@dataclass(frozen=True, slots=True)
class StringType:
    """Text up to a zero byte."""

    align: int = 8


@dataclass(frozen=True, slots=True)
class ArrayType:
    """Several values; the length is a number or the name of the field that has it."""

    element: FieldType
    length: int | str

    @property
    def align(self) -> int:
        """That of its elements."""
        return self.element.align


@dataclass(frozen=True, slots=True)
class StructType:
    """Named fields, one after the other."""

    fields: tuple[tuple[str, FieldType], ...]
    align: int = 1


@dataclass(frozen=True, slots=True)
class VariantType:
    """One of several types, which the label of a field that is an enumeration selects."""

    tag: str
    options: Mapping[str, FieldType]
    align: int = 1


FieldType: TypeAlias = IntegerType | FloatType | EnumerationType | StringType | ArrayType | StructType | VariantType
