"""Values of a description that could shorten latencies: what people change about micro-ROS in practice, each to be tried."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.change import Change, compact
from amalthea_uros.design.description.keys import DescriptionKey, short_name
from amalthea_uros.spec.written import Written
from amalthea_uros.units import parse_bit_rate, parse_data_size, parse_time, time_text

#: The rate up to which USB bridges and most controllers go without special care; that of the examples for fast boards.
_BAUD_RATE = 921_600
#: The highest bit rate of classic CAN (ISO 11898-1).
_BITRATE = "1 Mbit/s"
#: The shortest sleep and timeout that are tried: the tick that most ports have.
_SHORTEST = "1 ms"
#: Where values are tried.
_SECTIONS = {"loop", "serial", "can", "driver", "subscriptions", "publishers", "timers", "os", "tasks", "executor", "executors"}
#: Bytes: of smaller messages, the headers are most of what is sent.
_SMALL_MESSAGE = 16


@dataclass(frozen=True, slots=True, kw_only=True)
class Suggestion:
    """A value to try.

    Attributes
    ----------
    text : what changes, in words
    """

    text: str
    change: Change


def suggestions(keys: Sequence[DescriptionKey], cores: Sequence[str] = ()) -> Iterator[Suggestion]:
    """The values to try, in the order of how easy they are to change.

    Parameters
    ----------
    cores : those of the controller
    """
    executors = [key.names[-2] for key in keys if key.path[-1] == "loop" and "executors" in key.path]
    values = {
        **_VALUES,
        "runs_in": lambda present: _others(present, ("own-task", *executors)),
        "core": lambda present: _others(present, cores),
        "message_size": _smaller,
    }
    defaults = {"runs_in": "executor", "core": next(iter(cores), None)}
    for last, others in values.items():
        for key in keys:
            if key.path[-1] == last and _is_meant(key) and not _is_tried_elsewhere(key):
                present = defaults.get(last) if key.value is None else key.value
                yield from (_suggestion(key, present, value, keys) for value in others(present))


def _is_meant(key: DescriptionKey) -> bool:
    """Whether a key is about an executor, a wire, a task or a message, and not about something else of the same name."""
    return not _SECTIONS.isdisjoint(map(str, key.path))


def _is_tried_elsewhere(key: DescriptionKey) -> bool:
    """Whether a period is that of a process that is built, whose periods, priorities and offsets are tried alike in all systems."""
    return key.path[-1] == "period" and "timers" not in key.path


def _suggestion(key: DescriptionKey, present: Written | None, value: str, keys: Sequence[DescriptionKey]) -> Suggestion:
    target = short_name(key, keys)
    name, _, last = target.rpartition(".")
    return Suggestion(text=f"{target} {present} -> {value}", change=Change(name, last, compact(value)))


def _shorter(present: Written | None) -> Iterator[str]:
    if isinstance(present, str) and parse_time(present) > parse_time(_SHORTEST):
        yield _SHORTEST


def _half(present: Written | None) -> Iterator[str]:
    """Of the period of a timer."""
    if isinstance(present, str) and parse_time(present) % 2 == 0:
        yield time_text(parse_time(present) // 2)


def _smaller(present: Written | None) -> Iterator[str]:
    """Half of a message, as one that has a narrower type of its numbers, or leaves out what nobody uses."""
    size = parse_data_size(present) // 8 if isinstance(present, str) else 0
    if size >= _SMALL_MESSAGE:
        yield f"{size // 2} B"


def _others(present: Written | None, offered: Sequence[str]) -> Iterator[str]:
    """Values that are available besides the present one."""
    yield from (each for each in dict.fromkeys(offered) if each != present)


def _faster_line(present: Written | None) -> Iterator[str]:
    if isinstance(present, int) and present < _BAUD_RATE:
        yield str(_BAUD_RATE)


def _faster_bus(present: Written | None) -> Iterator[str]:
    if isinstance(present, str) and parse_bit_rate(present) < parse_bit_rate(_BITRATE):
        yield _BITRATE


def _without_ticks(present: Written | None) -> Iterator[str]:
    """The driver that is woken by the end of a transfer, instead of asking in each tick."""
    if present in ("dma", "interrupt"):
        yield "blocking"


def _unacknowledged(present: Written | None) -> Iterator[str]:
    if present == "reliable":
        yield "best-effort"


#: The last name of a key -> the values to try instead of the present one.
_VALUES: Mapping[str, Callable[[Written | None], Iterator[str]]] = {
    "sleep": _shorter,
    "spin_some": _shorter,
    "spin_period": _shorter,
    "timeout": _shorter,
    "tick": _shorter,
    "write": _without_ticks,
    "read": _without_ticks,
    "baud_rate": _faster_line,
    "bitrate": _faster_bus,
    "reliability": _unacknowledged,
    "period": _half,
}
