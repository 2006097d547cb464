"""Chains over wires and executors for people: the headline latency, a table of several, and the hops of one."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.report.cells import share_text
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text

#: Of a table with a row for each chain; the last column has none.
HEADINGS = ("chain", "from", "to", ">best", ">worst")
#: Parts of a latency that its line names.
_LARGEST = 2


def latency_row(chain: ChainResult) -> tuple[str, ...]:
    """The latency of a chain with a remark, in a row of a table."""
    best, worst = _time(chain.best, Rounding.DOWN), _time(chain.worst, Rounding.UP)
    return (chain.name, chain.start, chain.end, best, worst, remark(chain))


def headline(chain: ChainResult) -> str:
    """The latency of a chain in a sentence."""
    latency, best = f"Worst latency from {chain.start} to {chain.end}", _time(chain.best, Rounding.DOWN)
    if chain.worst is None:
        return f"{latency}: unknown, at least {best}; {remark(chain)}"
    return f"{latency}: {_time(chain.worst, Rounding.UP)} (bound), best {best}; {remark(chain)}"


def remark(chain: ChainResult) -> str:
    """What takes most of the latency of a chain, or why it is unknown."""
    if chain.worst_if_not_lost is None:
        return f"{chain.reason}. {chain.remedy}" if chain.remedy else chain.reason
    if chain.loss:
        return f"at most {_time(chain.worst_if_not_lost, Rounding.UP)} for messages that are not lost; {chain.loss}"
    largest = sorted(_largest_parts(chain), key=lambda part: -part[1])[:_LARGEST]
    return f"most of it: {', '.join(f'{name} {_time(time, Rounding.UP)}' for name, time in largest)}"


def _largest_parts(chain: ChainResult) -> Iterator[tuple[str, Time]]:
    for hop in chain.hops:
        owner = f"{hop.kind} {hop.name}"
        named = [(f"{part.name} ({owner})", part.most) for part in hop.parts if part.most is not None and part.most > 0]
        yield from named or [(owner, hop.worst or 0)]


def write_hops_of_chain(chain: ChainResult, terminal: Terminal) -> None:
    """Write the hops of a chain with their parts; the columns best and worst add up to the latency."""
    rows: list[tuple[str, ...]] = []
    for hop in chain.hops:
        note = hop.reason or hop.source
        rows.append((f"{hop.kind}: {hop.name}", time_text(hop.best), _exact(hop.worst), share_text(hop.share), note))
        rows += [(f"  {part.name}", "", _exact(part.most), "", part.why) for part in hop.parts]
    rows.append(("sum", time_text(chain.best or 0), _exact(chain.worst_if_not_lost), "", ""))
    terminal.table(("hop", "best", "worst", "share", ""), rows, right=(1, 2, 3))
    terminal.line("  the latency is the sum of the bounds of its hops, which need not occur in one run")
    if chain.loss:
        terminal.line(f"  the sum only holds for messages that are not lost: {chain.loss}")
    for hop in chain.hops:
        if hop.worst is None and hop.remedy:
            terminal.line(f"  {hop.remedy}")


def _exact(value: Time | None) -> str:
    return "unknown" if value is None else time_text(value)


def _time(value: Time | None, rounding: Rounding) -> str:
    return "unknown" if value is None else rounded_time_text(value, rounding)
