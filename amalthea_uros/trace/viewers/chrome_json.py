"""Traces as JSON of Chrome's trace viewer, which Perfetto and others show ("Trace Event Format"); the content is that of `perfetto`.

Slices are complete events (X), because begin and end events of one track at the same time are ambiguous. There is no `displayTimeUnit`:
older versions of Perfetto took it for the unit of the times, which are microseconds.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros.trace.table import Entity
from amalthea_uros.trace.viewers.timeline import FIRST_TRACK, GROUPS, TimelineEncoder, TrackChange, TrackMark


class _Track:
    """The slices of a track since it was last without an open one, in the order in which they begin.

    A slice is known when it ends, but must come before those in it: viewers keep the order of slices that begin at the same time.
    """

    __slots__ = ("ends", "marks", "open")

    def __init__(self) -> None:
        self.marks: list[TrackMark] = []
        self.ends: list[int] = []
        self.open: list[int] = []

    def add(self, mark: TrackMark) -> None:
        """Add a mark."""
        if mark.change is TrackChange.END:
            self.ends[self.open.pop()] = mark.time
            return
        if mark.change is TrackChange.BEGIN:
            self.open.append(len(self.marks))
        self.marks.append(mark)
        self.ends.append(mark.time)

    def take(self) -> Iterator[tuple[TrackMark, int]]:
        """The begins with their ends, if all of them are known; they are no longer kept."""
        if not self.open:
            yield from zip(self.marks, self.ends, strict=True)
            self.marks.clear()
            self.ends.clear()


class ChromeEncoder(TimelineEncoder):
    """Makes the JSON. What the format calls processes are the groups of tracks, and each track is a thread of one."""

    def __init__(self, entities: Sequence[Entity]) -> None:
        super().__init__(entities)
        self._tracks: dict[int, _Track] = {}
        #: The fields that do not depend on the time, by track, state and entity.
        self._places: dict[tuple[int, str, int], str] = {}

    def begin(self) -> bytes:
        """The names of the groups of tracks."""
        groups = (_metadata("process_name", group, group, name=title) for group, title in GROUPS.items())
        return ('{"traceEvents":[\n' + ",\n".join(groups)).encode()

    def end(self) -> bytes:
        """The slices that are still open, and the end of the JSON."""
        return super().end() + b"\n]}\n"

    def _encoded(self, marks: Iterable[TrackMark]) -> bytes:
        return "".join(self._events(marks)).encode()

    def _events(self, marks: Iterable[TrackMark]) -> Iterator[str]:
        for mark in marks:
            track = self._tracks.get(mark.track)
            if track is None:
                track = self._tracks[mark.track] = _Track()
                yield from self._description(mark.track)
            track.add(mark)
            for begin, end in track.take():
                yield f",\n{self._slice(begin, end)}"

    def _slice(self, mark: TrackMark, end: int) -> str:
        key = mark.track, mark.state, mark.entity
        place = self._places.get(key)
        if place is None:
            name = json.dumps(mark.state or self._entities[mark.entity].name, ensure_ascii=False)
            place = f'"ph":"X","pid":{self._group(mark.track)},"tid":{FIRST_TRACK + mark.track},"name":{name}'
            self._places[key] = place
        times = f'"ts":{_microseconds(mark.time)},"dur":{_microseconds(end - mark.time)}'
        return f"{{{place},{times}{_flow(mark)}}}"

    def _description(self, track: int) -> Iterator[str]:
        group, thread, name = self._group(track), FIRST_TRACK + track, self._entities[track].name
        yield f",\n{_metadata('thread_name', group, thread, name=name)}"
        yield f",\n{_metadata('thread_sort_index', group, thread, sort_index=track)}"


def _flow(mark: TrackMark) -> str:
    """The fields that connect the steps of one occurrence by arrows."""
    if not mark.flow:
        return ""
    incoming = "" if mark.step == 0 else ',"flow_in":true'
    return f',"bind_id":"{mark.flow:#x}","flow_out":true{incoming}'


def _metadata(kind: str, group: int, thread: int, **arguments: str | int) -> str:
    event = {"ph": "M", "name": kind, "pid": group, "tid": thread, "args": arguments}
    return json.dumps(event, ensure_ascii=False, separators=(",", ":"))


def _microseconds(picoseconds: int) -> str:
    """Exact decimals: a number in floating point would lose the picoseconds of long traces."""
    return f"{picoseconds // 10**6}.{picoseconds % 10**6:06d}"
