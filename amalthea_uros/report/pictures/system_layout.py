"""Where the boxes of a system picture are, and the ways of the lines between them.

Boxes are in columns by data flow, each in a row of its own. A line leaves a box at its right, goes along the row of this box, turns
into a track between two columns, and reaches the other box along the row of that one: from the left if that is in a later column,
otherwise from the right. Rows have one box, and tracks none, so that no line runs through a box, and none along another one.

The columns are the layers of the longest paths, as in K. Sugiyama, S. Tagawa and M. Toda, "Methods for visual understanding of
hierarchical system structures", IEEE Transactions on Systems, Man, and Cybernetics 11(2), 1981. The rows are given.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from amalthea_uros._internal.graphs import bottom_up, reached
from amalthea_uros._internal.records import dataclass
from amalthea_uros.report.pictures.svg import SMALL_SIZE, text_width

#: Pixels: of a box, between boxes, between the tracks and lines.
BOX, LOWEST, PORT = 168.0, 50.0, 15.0
_ROW_GAP, _TRACK, _BAND_HEADER, _BAND_GAP, _PADDING = 12.0, 9.0, 26.0, 14.0, 12.0
_NARROWEST_LABEL, _WIDEST_LABEL, _ARROW = 24.0, 124.0, 16.0
#: Deeper boxes are in the last column.
MOST_COLUMNS = 5

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class LayoutWire:
    """A line from one box to others.

    Attributes
    ----------
    source : a box, or what comes from outside if it has none
    """

    source: str
    targets: tuple[str, ...]
    label: str
    is_outer: bool = False


@dataclass(frozen=True, slots=True)
class LayoutBox:
    """A box in pixels."""

    left: float
    top: float
    height: float

    @property
    def right(self) -> float:
        """The right edge."""
        return self.left + BOX


@dataclass(frozen=True, slots=True)
class DrawnWire:
    """The ways of a wire to each of its targets, and the room for its label from its start on."""

    wire: LayoutWire
    ways: Mapping[str, tuple[Point, ...]]
    room: float

    @property
    def start(self) -> Point:
        """Where it begins."""
        return next(iter(self.ways.values()))[0]


@dataclass(frozen=True, slots=True)
class Layout:
    """Boxes, bands of boxes as (upper edge, height), and wires."""

    boxes: Mapping[str, LayoutBox]
    bands: tuple[tuple[float, float], ...]
    wires: tuple[DrawnWire, ...]
    left: float
    right: float
    bottom: float


def lay_out(bands: Sequence[Sequence[str]], wires: Sequence[LayoutWire], left: float, top: float) -> Layout:
    """The layout of boxes in bands, one below the other."""
    rows = [name for band in bands for name in band]
    columns = _columns(rows, [wire for wire in wires if not wire.is_outer])
    ports = _Ports.of(rows, columns, wires)
    tracks = _tracks(columns, wires)
    rooms = _rooms(columns, wires)
    lefts, right = _lefts(left, columns, tracks, rooms)
    boxes: dict[str, LayoutBox] = {}
    drawn_bands, y = [], top
    for band in bands:
        begin, y = y, y + _BAND_HEADER
        for name in band:
            boxes[name] = LayoutBox(lefts[columns[name]], y, ports.height(name))
            y += boxes[name].height + _ROW_GAP
        drawn_bands.append((begin, y - begin))
        y += _BAND_GAP
    router = _Router(columns, boxes, ports, tracks, rooms, lefts)
    return Layout(
        boxes, tuple(drawn_bands), tuple(router.drawn(number, wire) for number, wire in enumerate(wires)), left, right, y
    )


def _columns(rows: Sequence[str], wires: Iterable[LayoutWire]) -> dict[str, int]:
    """The layer of each box, without the wires that would close a circle."""
    following: dict[str, list[str]] = {name: [] for name in rows}
    for wire in wires:
        for target in wire.targets:
            if wire.source not in reached([target], following.__getitem__):
                following[wire.source].append(target)
    layers = dict.fromkeys(rows, 0)
    for name in reversed(bottom_up(rows, following.__getitem__)):
        for target in following[name]:
            layers[target] = max(layers[target], layers[name] + 1)
    return {name: min(layer, MOST_COLUMNS - 1) for name, layer in layers.items()}


def _turns(wire: LayoutWire, columns: Mapping[str, int]) -> dict[str, int]:
    """For each target the column after which the wire turns into a track; -1: before the first one."""
    if wire.is_outer:
        return dict.fromkeys(wire.targets, -1)
    start = columns[wire.source]
    return {target: columns[target] - 1 if columns[target] > start else start for target in wire.targets}


def _tracks(columns: Mapping[str, int], wires: Sequence[LayoutWire]) -> dict[int, list[int]]:
    """The numbers of the wires that have a track after each column."""
    found: dict[int, list[int]] = {}
    for number, wire in enumerate(wires):
        for gap in sorted(set(_turns(wire, columns).values())):
            found.setdefault(gap, []).append(number)
    return found


def _rooms(columns: Mapping[str, int], wires: Iterable[LayoutWire]) -> dict[int, float]:
    """The room for labels after each column."""
    found: dict[int, float] = {}
    for wire in wires:
        column = -1 if wire.is_outer else columns[wire.source]
        width = min(max(text_width(wire.label, SMALL_SIZE) + 8, _NARROWEST_LABEL), _WIDEST_LABEL)
        found[column] = max(found.get(column, 0), width)
    return found


def _lefts(
    left: float, columns: Mapping[str, int], tracks: Mapping[int, Sequence[int]], rooms: Mapping[int, float]
) -> tuple[list[float], float]:
    """The left edges of the columns, and the right end of all."""
    x = left + _PADDING + _gap(-1, tracks, rooms)
    lefts = []
    for column in range(max(columns.values(), default=0) + 1):
        lefts.append(x)
        x += BOX + _gap(column, tracks, rooms)
    return lefts, x + _PADDING


def _gap(column: int, tracks: Mapping[int, Sequence[int]], rooms: Mapping[int, float]) -> float:
    lines = len(tracks.get(column, ()))
    return rooms.get(column, 0) + (_TRACK * lines + _ARROW if lines else 0)


@dataclass(frozen=True, slots=True)
class _Ports:
    """The wires that end at each side of each box, from top to bottom."""

    right: Mapping[str, Sequence[tuple[int, str]]]
    left: Mapping[str, Sequence[int]]

    @classmethod
    def of(cls, rows: Sequence[str], columns: Mapping[str, int], wires: Sequence[LayoutWire]) -> _Ports:
        right: dict[str, list[tuple[float, int, str]]] = {name: [] for name in rows}
        left: dict[str, list[tuple[float, int]]] = {name: [] for name in rows}
        place = {name: index for index, name in enumerate(rows)}
        for number, wire in enumerate(wires):
            middle = sum(place[target] for target in wire.targets) / len(wire.targets)
            if not wire.is_outer:
                right[wire.source].append((middle, number, ""))
            for target in wire.targets:
                origin = -1.0 if wire.is_outer else place[wire.source]
                if wire.is_outer or columns[target] > columns[wire.source]:
                    left[target].append((origin, number))
                else:
                    right[target].append((origin, number, wire.source))
        return cls(
            {name: [(number, source) for _, number, source in sorted(found)] for name, found in right.items()},
            {name: [number for _, number in sorted(found)] for name, found in left.items()},
        )

    def height(self, name: str) -> float:
        """Of a box that has room for all."""
        return max(LOWEST, PORT * (1 + max(len(self.right[name]), len(self.left[name]))))


@dataclass(frozen=True, slots=True)
class _Router:
    """Finds the ways of wires."""

    columns: Mapping[str, int]
    boxes: Mapping[str, LayoutBox]
    ports: _Ports
    tracks: Mapping[int, Sequence[int]]
    rooms: Mapping[int, float]
    lefts: Sequence[float]

    def drawn(self, number: int, wire: LayoutWire) -> DrawnWire:
        """The ways of a wire to its targets."""
        turns = _turns(wire, self.columns)
        start = self._start(number, wire)
        ways = {
            target: self._way(start, self._track(gap, number), self._end(number, wire, target)) for target, gap in turns.items()
        }
        return DrawnWire(wire, ways, self.rooms[-1 if wire.is_outer else self.columns[wire.source]])

    def _start(self, number: int, wire: LayoutWire) -> Point:
        if not wire.is_outer:
            return self.boxes[wire.source].right, self._right_port(wire.source, (number, ""))
        return self.lefts[0] - _gap(-1, self.tracks, self.rooms), self._left_port(wire.targets[0], number)

    def _end(self, number: int, wire: LayoutWire, target: str) -> Point:
        box = self.boxes[target]
        if wire.is_outer or self.columns[target] > self.columns[wire.source]:
            return box.left, self._left_port(target, number)
        return box.right, self._right_port(target, (number, wire.source))

    def _way(self, start: Point, track: float, end: Point) -> tuple[Point, ...]:
        return (start, end) if start[1] == end[1] else (start, (track, start[1]), (track, end[1]), end)

    def _track(self, gap: int, number: int) -> float:
        begin = self.lefts[0] - _gap(-1, self.tracks, self.rooms) if gap < 0 else self.lefts[gap] + BOX
        return begin + self.rooms.get(gap, 0) + _TRACK * (self.tracks[gap].index(number) + 0.5)

    def _right_port(self, name: str, port: tuple[int, str]) -> float:
        return self._port(name, self.ports.right[name].index(port), len(self.ports.right[name]))

    def _left_port(self, name: str, number: int) -> float:
        return self._port(name, self.ports.left[name].index(number), len(self.ports.left[name]))

    def _port(self, name: str, index: int, count: int) -> float:
        box = self.boxes[name]
        return box.top + box.height * (index + 1) / (count + 1)
