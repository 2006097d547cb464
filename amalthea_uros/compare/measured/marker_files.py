"""Files that name the objects of CAN logs and their markers; docs/measure.md describes them.

Executor_Task: {start: 0x18000001, end: 0x18000002, kind: process, baseline: Empty_1kHz}
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any

from amalthea_uros._internal.files import FileError, read_text
from amalthea_uros._internal.limits import DESCRIPTION_SIZE
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.compare.measured.signals import Signals, Value
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.measure.markers import (
    Decoder,
    Marker,
    MarkerChain,
    MarkerCounter,
    MarkerPair,
    Measurable,
    ReportedStatistics,
    ReportedValue,
    parse_marker,
    refuse_overlap,
)
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.spec.nodes import MappingNode, Node, NodePlace, ScalarNode, YamlText, read_nodes
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import Time, parse_duration, parse_time

_COMMON = ("kind", "quantity", "baseline")
#: The keys of each form of object, that which tells the form first.
_FORMS = {
    "start": ("start", "end", "counter", "period", *_COMMON),
    "from": ("from", "to", "counter"),
    "value": ("value", "frame", "unit", *_COMMON),
    "mean": ("mean", "min", "max", "deviation", "count", "frame", "unit", *_COMMON),
}
_QUANTITIES = ("duration", *JobMetric)


def read_markers(path: Path, signals: Signals) -> tuple[Measurable, ...]:
    """The objects of a file.

    Raises
    ------
    ReadError : the file cannot be read, or something in it is wrong; carries a finding for each object with an error.
    """
    try:
        text = read_text(path, DESCRIPTION_SIZE)
    except FileError as error:
        raise ReadError([Finding("MEA010", Severity.ERROR, error.reason, Location(path), error.advice)]) from None
    node, source, findings = read_nodes(path, text)
    reader = _MarkerFileReader(source, signals, [*findings])
    objects = reader.objects(node)
    if reader.findings:
        raise ReadError(reader.findings)
    return objects


def counter_of(text: str, signals: Signals) -> MarkerCounter:
    """A counter in a payload.

    Raises
    ------
    ValueError : the text names no place in a payload.
    """
    value = signals.value(text)
    return MarkerCounter(decode=value.decode, modulus=1 << min(value.bits, 32))


@dataclass(slots=True)
class _MarkerFileReader:
    source: YamlText
    signals: Signals
    findings: list[Finding]
    _nodes: dict[str, Node] = field(default_factory=dict)

    def objects(self, node: Node) -> tuple[Measurable, ...]:
        """All objects; those with an error are left out, and a finding is added."""
        if not isinstance(node, MappingNode) or not node.items:
            wrong = self._wrong(node.place, "a file with markers names objects", "An example: Task: {start: 0x101, end: 0x102}")
            self.findings += wrong.findings
            return ()
        self._nodes = node.items
        found = []
        for name, item in node.items.items():
            try:
                found.append(self._object(name, item))
            except ReadError as error:
                self.findings += error.findings
        return tuple(found)

    def _wrong(self, place: NodePlace, message: str, advice: str = "") -> ReadError:
        """Something at a place is wrong."""
        return ReadError([Finding("MEA010", Severity.ERROR, message, self.source.location(place), advice)])

    def _object(self, name: str, node: Node) -> Measurable:
        if not isinstance(node, MappingNode):
            raise self._wrong(node.place, f"{name!r} must have keys", "An example: {start: 0x101, end: 0x102}")
        form = next((form for form in _FORMS if form in node.items), None)
        if form is None:
            raise self._wrong(node.place, f"{name!r} has no markers", f"Add one of the keys {', '.join(_FORMS)}.")
        for key in node.items:
            if key not in _FORMS[form]:
                advice = did_you_mean(key, _FORMS[form]) or f"known: {', '.join(_FORMS[form])}"
                raise self._wrong(node.keys[key], f"{name!r} has an unknown key {key!r}", advice)
        build: dict[str, Callable[[str, MappingNode], Measurable]] = {
            "start": self._pair,
            "from": self._chain,
            "value": self._value,
            "mean": self._statistics,
        }
        return build[form](name, node)

    # The forms of objects.

    def _pair(self, name: str, node: MappingNode) -> MarkerPair:
        start, end = self._marker(name, node, "start"), self._marker(name, node, "end")
        self._refuse_overlap(start, end, node.items["end"].place)
        return MarkerPair(
            name=name,
            start=start,
            end=end,
            counter=self._counter(name, node),
            period=self._period(name, node),
            **self._common(name, node),
        )

    def _chain(self, name: str, node: MappingNode) -> MarkerChain:
        stimulus, response = self._end_of_chain(name, node, "from", "start"), self._end_of_chain(name, node, "to", "end")
        self._refuse_overlap(stimulus, response, node.items["to"].place)
        return MarkerChain(name=name, stimulus=stimulus, response=response, counter=self._counter(name, node))

    def _refuse_overlap(self, first: Marker, second: Marker, place: NodePlace) -> None:
        try:
            refuse_overlap(first, second)
        except ValueError as error:
            raise self._wrong(place, str(error)) from None

    def _end_of_chain(self, name: str, node: MappingNode, key: str, default: str) -> Marker:
        """A marker, or that of another object: `Task`, `Task.start`, `Task.end`."""
        text = self._text(name, node, key)
        other, _, which = text.partition(".")
        found = self._nodes.get(other)
        if isinstance(found, MappingNode) and (which or default) in found.items and (which or default) in ("start", "end"):
            return self._marker(other, found, which or default)
        try:
            return parse_marker(text)
        except ValueError:
            names = [each for each, item in self._nodes.items() if isinstance(item, MappingNode) and "start" in item.items]
            advice = did_you_mean(other, names) or f"known: {', '.join(names)}"
            message = f"{text!r} in {name!r} is neither a marker nor an object with a start and an end"
            raise self._wrong(node.items[key].place, message, advice) from None

    def _value(self, name: str, node: MappingNode) -> ReportedValue:
        (value,), marker = self._reported(name, node, ("value",))
        assert value is not None
        return ReportedValue(name=name, marker=marker, value=value, **self._common(name, node))

    def _statistics(self, name: str, node: MappingNode) -> ReportedStatistics:
        keys = ("min", "mean", "max", "deviation", "count")
        (low, mean, high, deviation, count), marker = self._reported(name, node, keys)
        if low is None or mean is None or high is None:
            raise self._wrong(node.place, f"the statistics of {name!r} need the keys min, mean and max")
        common = self._common(name, node)
        return ReportedStatistics(
            name=name, marker=marker, min=low, mean=mean, max=high, deviation=deviation, count=count, **common
        )

    def _reported(self, name: str, node: MappingNode, keys: Iterable[str]) -> tuple[list[Decoder | None], Marker]:
        """What decodes the values, as picoseconds but for the count, and the frame with all of them."""
        unit = self._unit(name, node)
        values = [self._place(name, node, key) if key in node.items else None for key in keys]
        markers = {value.marker for value in values if value is not None and value.marker is not None}
        if "frame" in node.items:
            markers.add(self._marker(name, node, "frame"))
        if len(markers) != 1:
            message = f"the values of {name!r} are in {len(markers)} frames" if markers else f"{name!r} names no frame"
            raise self._wrong(node.place, message, "State the identifier of the frame that has them: frame: 0x18000100")
        scales = [Fraction(1) if key == "count" else unit for key in keys]
        decoders = [
            None if value is None else _scaled(value.decode, scale) for value, scale in zip(values, scales, strict=True)
        ]
        return decoders, markers.pop()

    # Keys.

    def _common(self, name: str, node: MappingNode) -> dict[str, Any]:
        kind = self._choice(
            name, node, "kind", [each for each in MeasuredKind if each is not MeasuredKind.CHAIN], MeasuredKind.INTERVAL
        )
        quantity = self._choice(name, node, "quantity", _QUANTITIES, "duration")
        baseline = self._text(name, node, "baseline") if "baseline" in node.items else None
        if baseline is not None and baseline not in self._nodes:
            advice = did_you_mean(baseline, self._nodes) or f"known: {', '.join(self._nodes)}"
            message = f"the baseline {baseline!r} of {name!r} is not an object of this file"
            raise self._wrong(node.items["baseline"].place, message, advice)
        return {"kind": MeasuredKind(kind), "quantity": quantity, "baseline": baseline}

    def _choice(self, name: str, node: MappingNode, key: str, choices: Iterable[str], default: str) -> str:
        if key not in node.items:
            return default
        text, known = self._text(name, node, key), list(map(str, choices))
        if text not in known:
            advice = did_you_mean(text, known) or f"known: {', '.join(known)}"
            raise self._wrong(node.items[key].place, f"{text!r} is no {key} of {name!r}", advice)
        return text

    def _text(self, name: str, node: MappingNode, key: str) -> str:
        value = node.items.get(key)
        if value is None:
            raise self._wrong(node.place, f"{name!r} has no key {key!r}")
        if not isinstance(value, ScalarNode) or value.value is None or isinstance(value.value, bool):
            raise self._wrong(value.place, f"{key!r} of {name!r} must be a text")
        return str(value.value)

    def _marker(self, name: str, node: MappingNode, key: str) -> Marker:
        found: Marker = self._parsed(name, node, key, parse_marker)
        return found

    def _place(self, name: str, node: MappingNode, key: str) -> Value:
        found: Value = self._parsed(name, node, key, self.signals.value)
        return found

    def _counter(self, name: str, node: MappingNode) -> MarkerCounter | None:
        if "counter" not in node.items:
            return None
        found: MarkerCounter = self._parsed(name, node, "counter", lambda text: counter_of(text, self.signals))
        return found

    def _period(self, name: str, node: MappingNode) -> Time | None:
        return None if "period" not in node.items else self._parsed(name, node, "period", parse_duration)

    def _unit(self, name: str, node: MappingNode) -> Fraction:
        """The picoseconds of the unit: `us`, or `0.1 us`."""
        if "unit" not in node.items:
            raise self._wrong(node.place, f"{name!r} has no unit", "State the unit of the values: unit: us")
        text = self._text(name, node, "unit")
        time: Time = self._parsed(name, node, "unit", lambda _: parse_time(text if text[:1].isdigit() else f"1 {text}"))
        return Fraction(time)

    def _parsed(self, name: str, node: MappingNode, key: str, parse: Callable[[str], Any]) -> Any:
        text = self._text(name, node, key)
        try:
            return parse(text)
        except ValueError as error:
            raise self._wrong(node.items[key].place, f"{key!r} of {name!r}: {error}") from None


def _scaled(decode: Decoder, scale: Fraction) -> Decoder:
    def scaled(data: bytes) -> Fraction | None:
        value = decode(data)
        return None if value is None else value * scale

    return scaled
