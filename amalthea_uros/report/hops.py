"""The hops of the worst case of a chain in a table."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.analyze.results.explanations import ChainExplanation
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time, time_text


def write_hops(explanation: ChainExplanation, total: Time, claim: Claim, terminal: Terminal) -> None:
    """Write a row for each hop, with times relative to the first read; the columns wait and run add up to the value."""
    hops = explanation.hops
    columns = {
        "process": [hop.process for hop in hops],
        "job": ["-" if hop.job is None else str(hop.job) for hop in hops],
        "release": [_time(hop.release) for hop in hops],
        "start": [_time(hop.start) for hop in hops],
        "read": [_time(hop.read) for hop in hops],
        "write": [_time(hop.write) for hop in hops],
        "wait": [time_text(hop.wait) for hop in hops],
        "run": [time_text(hop.run) for hop in hops],
        "share": [_percent(explanation.share(hop.wait + hop.run)) for hop in hops],
    }
    known = {name: cells for name, cells in columns.items() if set(cells) != {"-"}}
    rows = [list(row) for row in zip(*known.values(), strict=True)]
    empty = [""] * (len(known) - 4)
    if explanation.overwritten:
        share = explanation.share(explanation.overwritten)
        rows.append(["until overwritten", *empty, time_text(explanation.overwritten), "", _percent(share)])
    waits, runs = sum(hop.wait for hop in hops) + explanation.overwritten, sum(hop.run for hop in hops)
    rows.append(["sum", *empty, time_text(waits), time_text(runs), ""])
    terminal.table(tuple(known), rows, right=range(1, len(known)))
    terminal.line(f"  waits and runs add up to {time_text(total)}; other times are relative to the first read")
    if claim is Claim.BOUND:
        terminal.line("  each read is as early and each write as late as possible, which need not occur in one run")


def _time(value: Time | None) -> str:
    return "-" if value is None else time_text(value)


def _percent(share: Fraction) -> str:
    return f"{float(share):.1%}"
