"""Descriptions of the messages on a CAN bus (DBC files), by cantools, which is optional."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from fractions import Fraction
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from amalthea_uros._internal.files import FileError, read_bytes
from amalthea_uros._internal.limits import MODEL_SIZE
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.trace.can.dbc_sizes import wrong_size
from amalthea_uros.trace.can.frames import EXTENDED
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from cantools.database.can import Message as CantoolsMessage
    from cantools.database.can import Signal as CantoolsSignal

_MILLISECOND = 10**9
_CYCLE_TIME = "GenMsgCycleTime"


@dataclass(frozen=True, slots=True)
class DbcSignal:
    """A value in the payload of a message: `raw * scale + offset`.

    Attributes
    ----------
    bits : of the raw value
    """

    name: str
    bits: int
    scale: Fraction
    offset: Fraction
    _decode: Callable[[bytes], Mapping[str, Any]] = field(repr=False, compare=False)

    def raw(self, data: bytes) -> Fraction | None:
        """The value before scaling; None if the payload is too short, or has another signal in this place (multiplexing)."""
        value = self._decode(data).get(self.name)
        return None if value is None or not isfinite(value) else Fraction(value)

    def value(self, data: bytes) -> Fraction | None:
        """The value, exactly; None as for `raw`."""
        raw = self.raw(data)
        return None if raw is None else raw * self.scale + self.offset


@dataclass(frozen=True, slots=True)
class DbcMessage:
    """A message.

    Attributes
    ----------
    identifier : as in a table of frames: with the bit `EXTENDED` if it has 29 bits
    length : of the payload in bytes
    cycle_time : picoseconds; None if none is stated for this message: the default of the file holds for messages without a cycle, too
    """

    name: str
    identifier: int
    length: int
    cycle_time: Time | None
    signals: Mapping[str, DbcSignal]


@dataclass(frozen=True, slots=True)
class DbcDatabase:
    """The messages of a bus, by their names."""

    path: Path
    messages: Mapping[str, DbcMessage]

    def find(self, text: str) -> tuple[DbcMessage, DbcSignal]:
        """The signal that is written as `DbcMessage.Signal`.

        Raises
        ------
        InvalidArgumentError : there is none.
        """
        name, _, signal_name = text.partition(".")
        message = self.messages.get(name)
        if message is None:
            raise InvalidArgumentError(f"{self.path} has no message {name!r}{_hint(name, self.messages)}")
        signal = message.signals.get(signal_name)
        if signal is None:
            hint = _hint(signal_name, message.signals)
            raise InvalidArgumentError(f"the message {name!r} of {self.path} has no signal {signal_name!r}{hint}")
        return message, signal


def read_dbc(path: Path) -> DbcDatabase:
    """Read a DBC file.

    Raises
    ------
    InvalidArgumentError : cantools is not installed.
    ReadError : the file cannot be read, or is not a DBC file; says where.
    """
    try:
        from cantools.database.can import Database as CantoolsDatabase
    except ImportError as error:
        raise InvalidArgumentError("DBC files need cantools; install it with: pip install amuros[can]") from error
    try:
        text = read_bytes(path, MODEL_SIZE).decode("cp1252", "replace")
    except FileError as error:
        raise ReadError([Finding("CAN012", Severity.ERROR, error.reason, Location(path), error.advice)]) from None
    if (wrong := wrong_size(text)) is not None:
        raise ReadError([_invalid(wrong.message, Location(path, wrong.line, wrong.column))])
    import logging

    # Warnings of cantools would be written to standard error as they are.
    logging.getLogger("cantools").addHandler(logging.NullHandler())
    database = CantoolsDatabase()
    try:
        database.add_dbc_string(text)
        messages = [_message(message) for message in database.messages]
    except Exception as error:  # of many kinds: of the parser, of cantools, and of what it uses
        raise ReadError([_not_dbc(path, error)]) from None
    name, count = max(Counter(message.name for message in messages).items(), key=lambda each: each[1], default=("", 0))
    if count > 1:
        raise ReadError([_invalid(f"{count} messages have the name {name!r}", Location(path))])
    return DbcDatabase(path, {message.name: message for message in messages})


def _message(message: CantoolsMessage) -> DbcMessage:
    decode = _decoder(message)
    return DbcMessage(
        name=message.name,
        identifier=message.frame_id | (EXTENDED if message.is_extended_frame else 0),
        length=message.length,
        cycle_time=_cycle_time(message),
        signals={signal.name: _signal(signal, decode) for signal in message.signals},
    )


def _signal(signal: CantoolsSignal, decode: Callable[[bytes], Mapping[str, Any]]) -> DbcSignal:
    return DbcSignal(signal.name, signal.length, _exact(signal.scale), _exact(signal.offset), decode)


def _decoder(message: CantoolsMessage) -> Callable[[bytes], Mapping[str, Any]]:
    """What gives the raw values of a payload; none if it does not fit the message."""
    from cantools.database.errors import DecodeError

    def decode(data: bytes) -> Mapping[str, Any]:
        try:
            values = message.decode(data, decode_choices=False, scaling=False)
        except DecodeError:
            return {}
        return values if isinstance(values, dict) else {}

    return decode


def _exact(number: float | str) -> Fraction:
    """The decimal number that the file has: the shortest one that gives the same floating-point number."""
    return Fraction(str(number))


def _cycle_time(message: CantoolsMessage) -> Time | None:
    """What is stated for the message itself; 0 stands for none."""
    attribute = message.dbc.attributes.get(_CYCLE_TIME) if message.dbc is not None else None
    return None if attribute is None else round(_exact(attribute.value) * _MILLISECOND) or None


def _not_dbc(path: Path, error: Exception) -> Finding:
    # Errors of the parser know line and column.
    line, column = (getattr(error, name, None) for name in ("line", "column"))
    place = Location(path, line, column) if isinstance(line, int) and isinstance(column, int) else Location(path)
    return _invalid(str(error), place)


def _invalid(reason: str, place: Location) -> Finding:
    return Finding("CAN012", Severity.ERROR, f"not a valid DBC file: {reason}", place, "Correct it, or save it again as DBC.")


def _hint(name: str, known: Mapping[str, object]) -> str:
    return f"; {hint}" if (hint := did_you_mean(name, known)) else f"; known: {', '.join(known) or 'none'}"
