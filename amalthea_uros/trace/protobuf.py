"""The wire format of Protocol Buffers, as far as writing needs it (protobuf.dev, "Encoding")."""

from __future__ import annotations

_VARINT, _FIXED64, _LENGTH = 0, 1, 2
#: The numbers that are one byte, which most are.
_SINGLE = [bytes([number]) for number in range(0x80)]


def varint(number: int) -> bytes:
    """A number that is not negative, in groups of seven bits, the lowest first."""
    if number <= 0x7F:
        return _SINGLE[number]
    groups = bytearray()
    while number > 0x7F:
        groups.append(number & 0x7F | 0x80)
        number >>= 7
    groups.append(number)
    return bytes(groups)


def integer(field: int, number: int) -> bytes:
    """A field of type uint32, uint64, int32, int64 or an enumeration."""
    return varint(field << 3 | _VARINT) + varint(number)


def fixed64(field: int, number: int) -> bytes:
    """A field of type fixed64."""
    return varint(field << 3 | _FIXED64) + number.to_bytes(8, "little")


def message(field: int, *parts: bytes) -> bytes:
    """A field with a message in it, of which the fields are given."""
    content = b"".join(parts)
    return varint(field << 3 | _LENGTH) + varint(len(content)) + content


def text(field: int, value: str) -> bytes:
    """A field of type string."""
    return message(field, value.encode())
