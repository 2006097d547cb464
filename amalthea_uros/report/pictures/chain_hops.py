"""The worst case of a chain: when each of its jobs waits and runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.results.explanations import ChainExplanation, ProcessHop
from amalthea_uros.report.pictures.axes import HEIGHT, TimeAxis, draw_grid, draw_time_axis
from amalthea_uros.report.pictures.job_rows import arrows_at, draw_activations
from amalthea_uros.report.pictures.page import (
    ARROW_END,
    LIMIT,
    MARGIN,
    PALETTE,
    TOP,
    WIDTH,
    Entry,
    limit_line,
    picture_of,
    swatch,
)
from amalthea_uros.report.pictures.svg import (
    SMALL_SIZE,
    TEXT_SIZE,
    Markup,
    elided,
    horizontal,
    joined,
    path_of,
    rect_at,
    text_at,
    text_width,
    tipped,
    vertical,
)
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time, time_text

#: Pixels: of a lane and its boxes, of what is above the lanes, and of the labels at the left.
_LANE, _BOX, _BASE, _HEAD, _GAP = 50, 18, 40, 30, 8
_NARROWEST_LABELS, _WIDEST_LABELS, _RIGHT = 180, 290, 40
#: A shorter run is drawn with this width.
_NARROWEST = 3.0
#: Longer ways are drawn up to this hop.
MOST_HOPS = 40


@dataclass(frozen=True, slots=True)
class _Lane:
    """A hop: it waits from `begin` to its read, then runs to its write."""

    hop: ProcessHop
    begin: Time
    colour: int
    top: float

    @property
    def base(self) -> float:
        """The lower edge of its boxes."""
        return self.top + _BASE


def draw_hops(explanation: ChainExplanation, limit: Time | None = None) -> Markup:
    """The jobs of the worst case, one in each lane, on one axis of time.

    Parameters
    ----------
    limit : of the latency, if there is one
    """
    hops = explanation.hops[:MOST_HOPS]
    title = f"{explanation.chain.name}: {explanation.quantity.replace('_', ' ')}"
    if not hops or explanation.value is None or explanation.value.value is None:
        return _nothing(title, explanation)
    lanes = _lanes(hops)
    axis = _axis(explanation, lanes, limit)
    bottom = lanes[-1].top + _LANE + (_LANE if explanation.overwritten else 0) + _GAP
    body = (
        draw_grid(axis, TOP + _HEAD, bottom),
        *(_labels(lane, axis) for lane in lanes),
        *(_boxes(lane, axis) for lane in lanes),
        *(_passing_on(before, lane, axis) for before, lane in pairwise(lanes)),
        _overwriting(explanation.overwritten, lanes[-1], axis),
        _total(explanation.value.value, limit, lanes[0].begin, axis, bottom),
        draw_time_axis(axis, bottom, "time since the first read"),
    )
    subtitle = _subtitle(explanation, explanation.value.value, limit)
    return picture_of(title, subtitle, body, bottom + HEIGHT + _GAP, _legend(lanes, explanation, limit), _notes(explanation))


def _lanes(hops: Sequence[ProcessHop]) -> list[_Lane]:
    colours: dict[str, int] = {}
    lanes = []
    begin = hops[0].read - hops[0].wait
    for index, hop in enumerate(hops):
        colour = colours.setdefault(hop.process, len(colours) % len(PALETTE))
        lanes.append(_Lane(hop, begin, colour, TOP + _HEAD + _LANE * index))
        begin = hop.write
    return lanes


def _axis(explanation: ChainExplanation, lanes: Sequence[_Lane], limit: Time | None) -> TimeAxis:
    begin = lanes[0].begin
    times = [time for lane in lanes for time in (lane.begin, lane.hop.read, lane.hop.write)]
    ends = [*times, lanes[-1].hop.write + explanation.overwritten, begin + 1, *([] if limit is None else [begin + limit])]
    widest = max(max(text_width(lane.hop.process, TEXT_SIZE), text_width(_details(lane.hop), SMALL_SIZE)) for lane in lanes)
    left = MARGIN + min(max(widest, _NARROWEST_LABELS), _WIDEST_LABELS) + 2 * _GAP
    return TimeAxis(min(times), max(ends), left, WIDTH - _RIGHT - left)


def _details(hop: ProcessHop) -> str:
    job = () if hop.job is None else (f"job {hop.job}",)
    waits = (f"waits {time_text(hop.wait)}",) if hop.wait else ()
    return ", ".join((*job, *waits, f"runs {time_text(hop.run)}"))


def _labels(lane: _Lane, axis: TimeAxis) -> Markup:
    room = axis.left - MARGIN - _GAP
    name = text_at(lane.hop.process, MARGIN, lane.base - 15, room=room)
    details = elided(_details(lane.hop), SMALL_SIZE, room)
    return tipped(_description(lane.hop), name, text_at(details, MARGIN, lane.base, "small muted"))


def _description(hop: ProcessHop) -> str:
    known = (("released", hop.release), ("started", hop.start))
    return ", ".join(
        (
            f"{hop.process}: {_details(hop)}",
            *(f"{what} at {time_text(time)}" for what, time in known if time is not None),
            f"reads at {time_text(hop.read)}",
            f"writes at {time_text(hop.write)}",
        )
    )


def _boxes(lane: _Lane, axis: TimeAxis) -> Markup:
    """The wait pale, the run full and never too narrow to be seen, the release as an arrow."""
    hop, top = lane.hop, lane.base - _BOX
    wait = (axis.x(lane.begin), axis.x(hop.read))
    run = (axis.x(min(hop.read, hop.write)), axis.x(max(hop.read, hop.write)))
    line = path_of("rule", horizontal(axis.left, axis.right, lane.base))
    parts = [line, draw_activations(arrows_at([hop.release], axis), top - 14, top)]
    if hop.wait > 0:
        parts.append(_box(*wait, top + 4, _BOX - 4, lane.colour, is_pale=True))
    parts.append(_box(run[0], max(run[1], run[0] + _NARROWEST), top, _BOX, lane.colour, is_pale=False))
    return tipped(_description(hop), joined(parts))


def _box(left: float, right: float, top: float, height: float, colour: int, *, is_pale: bool) -> Markup:
    look = {"fill_opacity": ".22"} if is_pale else {}
    return rect_at(f"c{colour}", left, top, right - left, height, **look)


def _passing_on(before: _Lane, lane: _Lane, axis: TimeAxis) -> Markup:
    """An arrow from the write of a job to the lane of the job that reads it."""
    x = axis.x(before.hop.write)
    return path_of("line", vertical(x, before.base, lane.base - _BOX + 3), marker_end=ARROW_END)


def _overwriting(overwritten: Time, last: _Lane, axis: TimeAxis) -> Markup:
    if not overwritten:
        return Markup("")
    left, right = axis.x(last.hop.write), axis.x(last.hop.write + overwritten)
    base = last.base + _LANE
    sentence = f"output is overwritten after {time_text(overwritten)}"
    label = text_at(sentence, MARGIN, base, "small muted", room=axis.left - MARGIN - _GAP)
    return joined((label, _box(left, right, base - _BOX + 4, _BOX - 4, last.colour, is_pale=True)))


def _total(value: Time, limit: Time | None, begin: Time, axis: TimeAxis, bottom: float) -> Markup:
    """The latency as a dimension line above all lanes, and the limit as a line through them."""
    y = TOP + 20
    left, right = axis.x(begin), axis.x(begin + value)
    label = time_text(value)
    half = text_width(label, TEXT_SIZE) / 2
    middle = min(max((left + right) / 2, axis.left + half), axis.right - half)
    parts = [
        path_of("instant", vertical(left, y - 5, bottom) + vertical(right, y - 5, bottom)),
        path_of("line", horizontal(left, right, y)),
        text_at(label, middle, y - 7, "header", anchor="middle"),
    ]
    if limit is not None:
        parts.append(limit_line(vertical(axis.x(begin + limit), y + 4, bottom)))
    return joined(parts)


def _legend(lanes: Sequence[_Lane], explanation: ChainExplanation, limit: Time | None) -> Iterator[Entry]:
    is_waiting = any(lane.hop.wait > 0 for lane in lanes) or explanation.overwritten
    yield is_waiting, swatch("c0", 10, fill_opacity=".22"), "data wait"
    yield True, swatch("c0"), "from the read to the write of a job"
    yield len(lanes) > 1, path_of("line", "M-6 -8V8", marker_end=ARROW_END), "data are passed on"
    is_released = any(lane.hop.release is not None for lane in lanes)
    yield is_released, draw_activations(arrows_at([0], TimeAxis(-1, 1, -1, 2)), -7, 7), "release of the job"
    yield limit is not None, LIMIT, f"limit {time_text(limit or 0)}"


def _notes(explanation: ChainExplanation) -> list[str]:
    notes = []
    if len(explanation.hops) > MOST_HOPS:
        notes.append(f"{counted(len(explanation.hops) - MOST_HOPS, 'hop')} after these not shown.")
    if explanation.value is not None and explanation.value.claim is Claim.BOUND:
        notes.append("Each read is as early and each write as late as possible, which need not occur in one run.")
    return notes


def _subtitle(explanation: ChainExplanation, value: Time, limit: Time | None) -> str:
    claim = "" if explanation.value is None else f" ({explanation.value.claim})"
    of_limit = "" if limit is None else f", limit {time_text(limit)}"
    waits = sum(hop.wait for hop in explanation.hops) + explanation.overwritten
    runs = sum(hop.run for hop in explanation.hops)
    hops = counted(len(explanation.hops), "hop")
    return f"{time_text(value)}{claim}{of_limit}, {hops}: waits {time_text(waits)}, runs {time_text(runs)}"


def _nothing(title: str, explanation: ChainExplanation) -> Markup:
    """A picture that says why there are no hops."""
    value = explanation.value
    total = "unknown" if value is None or value.value is None else f"{time_text(value.value)} ({value.claim})"
    reason = text_at(f"no single hops: {explanation.reason}", MARGIN, TOP + 20, "muted", room=WIDTH - 2 * MARGIN)
    return picture_of(title, total, [tipped(explanation.reason, reason)], TOP + 24)
