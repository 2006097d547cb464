"""Draw what each latency of a chain measures: python tools/draw_quantities.py docs/images

The pictures show a chain of two tasks, 1 every 4 and 2 every 6; jobs, reads and latencies are computed, not drawn by hand.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from amalthea_uros.analyze.chains import job_chains
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes
from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.schedule import PeriodicTask
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.timing.demand.multiframe import MultiframeDemand

TASKS = (
    PeriodicTask(name="Sensor", period=4, offset=0, demand=MultiframeDemand.constant(1), priority=1),
    PeriodicTask(name="Actuator", period=6, offset=0, demand=MultiframeDemand.constant(2), priority=0),
)
UNIT, LEFT, LANE, TOP = 26, 86, 46, 18
INK, SOFT, JOB, USED, MEASURE = "#1f2328", "#8b949e", "#d0d7de", "#79c0ff", "#cf222e"


@dataclass(frozen=True)
class Shown:
    """A latency: from when to when, and the jobs through which it goes."""

    start: int
    end: int
    sensor: int
    actuators: tuple[int, ...]


def chain_times() -> list[ReadWriteTimes]:
    """The reads and writes of both tasks."""
    cycle = schedule.hyperperiod(TASKS)
    jobs = schedule.schedule(TASKS, 2 * cycle, MultiframeDemand.worst_of)
    return [
        ReadWriteTimes(releases=j.releases, reads=j.begins, writes=j.ends, cycle=cycle, until=2 * cycle).extended(100)
        for j in jobs
    ]


def shown(quantity: LatencyQuantity, sensor: ReadWriteTimes, actuator: ReadWriteTimes) -> Shown:
    """Where the quantity is measured, in the second cycle or after it."""
    cycle = sensor.cycle
    first = np.flatnonzero((sensor.reads >= cycle) & (sensor.reads < 2 * cycle))
    last = np.flatnonzero((actuator.reads >= cycle) & (actuator.reads < 2 * cycle))
    reacts = job_chains.forward([sensor, actuator], first)
    used = job_chains.backward([sensor, actuator], last)
    inputs = np.unique(job_chains.backward([sensor, actuator], np.arange(1, len(actuator.reads) - 8)))
    inputs = inputs[(sensor.reads[inputs] >= cycle) & (sensor.reads[inputs] < 2 * cycle)]
    candidates: list[Shown] = []
    for k, m in zip(first.tolist(), reacts.tolist(), strict=True):
        begin = sensor.reads[k - 1] if quantity is LatencyQuantity.MAX_REACTION_TIME else sensor.reads[k]
        if quantity in (
            LatencyQuantity.MAX_REACTION_TIME,
            LatencyQuantity.MAX_REDUCED_REACTION_TIME,
            LatencyQuantity.MIN_FIRST_TO_FIRST,
        ):
            candidates.append(Shown(int(begin), int(actuator.writes[m]), k, (m,)))
    for m, k in zip(last.tolist(), used.tolist(), strict=True):
        if quantity is LatencyQuantity.MAX_DATA_AGE:
            candidates.append(Shown(int(sensor.reads[k]), int(actuator.writes[m + 1]), k, (m, m + 1)))
        if quantity in (LatencyQuantity.MAX_REDUCED_DATA_AGE, LatencyQuantity.MIN_LAST_TO_LAST):
            candidates.append(Shown(int(sensor.reads[k]), int(actuator.writes[m]), k, (m,)))
    everything = job_chains.backward([sensor, actuator], np.arange(len(actuator.reads) - 8))
    for k in inputs.tolist():
        outputs = np.flatnonzero(everything == k)
        before = sensor.reads[inputs[inputs < k][-1]] if (inputs < k).any() else None
        if quantity in (LatencyQuantity.MAX_LAST_TO_FIRST, LatencyQuantity.MIN_LAST_TO_FIRST):
            candidates.append(Shown(int(sensor.reads[k]), int(actuator.writes[outputs[0]]), k, (int(outputs[0]),)))
        if quantity is LatencyQuantity.MAX_FIRST_TO_LAST and before is not None:
            candidates.append(Shown(int(before), int(actuator.writes[outputs[-1]]), k, tuple(outputs.tolist())))
    pick = max if quantity.is_upper else min
    return pick(candidates, key=lambda each: each.end - each.start)


def x(time: float, origin: int) -> float:
    """Where a time is in the picture."""
    return LEFT + (time - origin) * UNIT


def jobs(name: str, row: int, times: ReadWriteTimes, used: set[int], origin: int, end: int) -> list[str]:
    """The jobs of a task as boxes."""
    bottom = TOP + row * LANE + 30
    parts = [
        f'<text x="{LEFT - 10}" y="{bottom - 8}" text-anchor="end">{name}</text>',
        f'<line x1="{LEFT}" y1="{bottom}" x2="{x(end, origin)}" y2="{bottom}" stroke="{INK}"/>',
    ]
    for number, (read, write) in enumerate(zip(times.reads.tolist(), times.writes.tolist(), strict=True)):
        if origin <= read and write <= end:
            fill = USED if number in used else JOB
            size = f'width="{(write - read) * UNIT}" height="20"'
            parts.append(f'<rect x="{x(read, origin)}" y="{bottom - 20}" {size} fill="{fill}" stroke="{INK}"/>')
    for release in times.releases.tolist():
        if origin <= release <= end:
            at = x(release, origin)
            parts.append(f'<path d="M{at} {bottom} v-27 m-3 5 l3 -5 l3 5" fill="none" stroke="{SOFT}"/>')
    return parts


def draw(quantity: LatencyQuantity, sensor: ReadWriteTimes, actuator: ReadWriteTimes) -> str:
    """The picture of a quantity."""
    found = shown(quantity, sensor, actuator)
    origin, end = found.start - 3, found.end + 3
    parts = jobs("Sensor", 0, sensor, {found.sensor}, origin, end)
    parts += jobs("Actuator", 1, actuator, set(found.actuators), origin, end)
    written = sensor.writes[found.sensor]
    for number in found.actuators:
        if quantity is LatencyQuantity.MAX_DATA_AGE and number == found.actuators[-1]:
            continue  # it overwrites the output, with newer data
        read = actuator.reads[number]
        parts.append(
            f'<path d="M{x(written, origin)} {TOP + 30} L{x(read, origin)} {TOP + LANE + 10}" stroke="{INK}" '
            'stroke-dasharray="3 2" fill="none" marker-end="url(#arrow)"/>'
        )
    level = TOP + 2 * LANE + 14
    for time in (found.start, found.end):
        parts.append(f'<line x1="{x(time, origin)}" y1="{TOP}" x2="{x(time, origin)}" y2="{level + 5}" stroke="{MEASURE}"/>')
    middle = (x(found.start, origin) + x(found.end, origin)) / 2
    parts.append(
        f'<path d="M{x(found.start, origin)} {level} H{x(found.end, origin)}" stroke="{MEASURE}" stroke-width="1.5" '
        'marker-start="url(#measure)" marker-end="url(#measure)"/>'
        f'<text x="{middle}" y="{level + 17}" text-anchor="middle" fill="{MEASURE}">'
        f"{quantity.replace('_', ' ')}: {found.end - found.start}</text>"
    )
    return picture(parts, x(end, origin) + 20, level + 26)


def draw_mean(sensor: ReadWriteTimes, actuator: ReadWriteTimes) -> str:
    """The reaction time of events at any moment, and its mean."""
    cycle = sensor.cycle
    first = np.flatnonzero((sensor.reads >= cycle) & (sensor.reads < 2 * cycle))
    ends = actuator.writes[job_chains.forward([sensor, actuator], first)]
    scale, bottom = 7, TOP + 110
    chains = job_chains.build_job_chains([sensor, actuator], cycle)
    assert chains is not None
    points = []
    for k, end in zip(first.tolist(), ends.tolist(), strict=True):
        before, read = int(sensor.reads[k - 1]), int(sensor.reads[k])
        points += [(before, end - before), (read, end - read)]
    origin = points[0][0]
    line = " ".join(f"{x(time, origin)},{bottom - value * scale}" for time, value in points)
    mean = chains.mean_reaction_time
    right = x(points[-1][0], origin)
    parts = [
        f'<text x="{LEFT - 10}" y="{bottom - 50}" text-anchor="end">reaction</text>',
        f'<line x1="{LEFT}" y1="{bottom}" x2="{right}" y2="{bottom}" stroke="{INK}"/>',
        f'<polyline points="{line}" fill="none" stroke="{USED}" stroke-width="2"/>',
        f'<line x1="{LEFT}" y1="{bottom - mean * scale}" x2="{right}" y2="{bottom - mean * scale}" stroke="{MEASURE}"/>',
        f'<text x="{(LEFT + right) / 2}" y="{bottom + 18}" text-anchor="middle">moment of the event</text>',
        f'<text x="{right + 6}" y="{bottom - mean * scale + 4}" fill="{MEASURE}">{mean:.3g}</text>',
    ]
    return picture(parts, right + 50, bottom + 28)


def picture(parts: list[str], width: float, height: float) -> str:
    """An SVG of some parts."""
    markers = "".join(
        f'<marker id="{name}" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" markerHeight="7" orient="auto-start-reverse">'
        f'<path d="M0 0 L8 4 L0 8 z" fill="{colour}"/></marker>'
        for name, colour in (("arrow", INK), ("measure", MEASURE))
    )
    body = "\n".join(parts)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" font-family="sans-serif" font-size="13">\n'
        f'<rect width="100%" height="100%" fill="#ffffff"/>\n<defs>{markers}</defs>\n{body}\n</svg>\n'
    )


def main() -> None:
    folder = Path(sys.argv[1])
    sensor, actuator = chain_times()
    for quantity in LatencyQuantity:
        if not quantity.is_mean:
            (folder / f"{quantity}.svg").write_text(draw(quantity, sensor, actuator))
    (folder / f"{LatencyQuantity.MEAN_REACTION_TIME}.svg").write_text(draw_mean(sensor, actuator))


if __name__ == "__main__":
    main()
