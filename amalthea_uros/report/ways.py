"""The ways of messages for people: the headline latency, a table of several, and the hops of one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros.analyze.ways.results import Way
from amalthea_uros.executors.results import Hop, Part
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

#: Of a table with a row for each way; the last column has none.
HEADINGS = ("chain", "from", "to", "best", "worst")
RIGHT = (3, 4)
#: Parts of a latency that its line names.
_LARGEST = 2


def write_ways(ways: Sequence[Way], terminal: Terminal) -> None:
    """Write a line for one way, or a table for several."""
    if len(ways) == 1:
        terminal.line(terminal.style(headline(ways[0]), "1"))
        terminal.line()
    elif ways:
        terminal.line(terminal.style("Latency of messages, end to end", "1"))
        terminal.table((*HEADINGS, ""), map(latency_row, ways), right=RIGHT)
        terminal.line()


def latency_row(way: Way) -> tuple[str, ...]:
    """The latency of a way with a remark, in a row of a table."""
    return (way.name, way.start, way.end, _time(way.best, Rounding.DOWN), _time(way.worst, Rounding.UP), remark(way))


def headline(way: Way) -> str:
    """The latency of a way in a sentence."""
    of_what = f"Worst latency from {way.start} to {way.end}"
    if way.worst is None:
        return f"{of_what}: unknown, at least {_time(way.best, Rounding.DOWN)}; {remark(way)}"
    bounds = f"{_time(way.worst, Rounding.UP)} (bound), best {_time(way.best, Rounding.DOWN)}"
    return f"{of_what}: {bounds}; {remark(way)}"


def remark(way: Way) -> str:
    """What takes most of the latency of a way, or why it is unknown."""
    if way.reason:
        return f"{way.reason}. {way.remedy}" if way.remedy else way.reason
    if way.loss:
        return f"at most {_time(way.delivered, Rounding.UP)} for what is not lost; {way.loss}"
    largest = ", ".join(f"{name} {_time(time, Rounding.UP)}" for name, time in _largest(way))
    return f"most of it: {largest}"


def write_hops_of_way(way: Way, terminal: Terminal) -> None:
    """Write the hops of a way with what they consist of; the columns best and worst add up to the latency."""
    rows: list[tuple[str, ...]] = []
    for hop in way.hops:
        share = way.share(hop)
        note = hop.reason or hop.source
        rows.append(
            (
                f"{hop.kind}: {hop.name}",
                time_text(hop.best),
                "?" if hop.worst is None else time_text(hop.worst),
                "" if share is None else f"{float(share):.1%}",
                note,
            )
        )
        rows += [(f"  {part.name}", "", part_time(part), "", part.why) for part in hop.parts]
    worst = "?" if way.delivered is None else time_text(way.delivered)
    rows.append(("sum", time_text(way.best), worst, "", ""))
    terminal.table(("hop", "best", "worst", "share", ""), rows, right=(1, 2, 3))
    terminal.line("  the latency is the sum of the bounds of its hops, which need not occur in one run")
    if way.loss:
        terminal.line(f"  the sum only holds for what is not lost: {way.loss}")
    for hop in way.hops:
        if hop.worst is None and hop.remedy:
            terminal.line(f"  {hop.remedy}")


def _largest(way: Way) -> list[tuple[str, Time]]:
    """The largest parts of the upper bound, the largest one first."""
    return sorted(_parts(way), key=lambda part: -part[1])[:_LARGEST]


def _parts(way: Way) -> Iterator[tuple[str, Time]]:
    for hop in way.hops:
        named = [part for part in hop.parts if part.most is not None and part.most > 0]
        yield from [(f"{part.name} ({_who(hop)})", part.most or 0) for part in named] or [(_who(hop), hop.worst or 0)]


def _who(hop: Hop) -> str:
    return f"{hop.kind} {hop.name}"


def part_time(part: Part) -> str:
    """The time that a part takes at most, exactly."""
    return "?" if part.most is None else time_text(part.most)


def _time(value: Time | None, rounding: Rounding) -> str:
    return "unknown" if value is None else rounded_time_text(value, rounding)
