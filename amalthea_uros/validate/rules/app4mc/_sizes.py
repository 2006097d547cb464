"""Data sizes that can be compared."""

from __future__ import annotations

from amalthea_uros.metamodel.classes import DataSize

#: Bits in a unit of data, by its name.
_BITS: dict[str | None, int] = {
    f"{prefix}{word}": size * base**power
    for word, size in (("bit", 1), ("B", 8))
    for base, prefixes in ((1000, ("", "k", "M", "G", "T")), (1024, ("", "Ki", "Mi", "Gi", "Ti")))
    for power, prefix in enumerate(prefixes)
}


def bits(size: DataSize | None) -> int | None:
    """A data size in bits, None if it is not known."""
    if size is None or size.value is None or size.unit not in _BITS:
        return None
    return size.value * _BITS[size.unit]


def is_larger(size: DataSize, other: DataSize) -> bool:
    """Whether it is known of a size that it is larger than another one."""
    size_bits, other_bits = bits(size), bits(other)
    return size_bits is not None and other_bits is not None and size_bits > other_bits
