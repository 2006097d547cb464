"""What was observed of applications, and how much of it has a bound."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from statistics import median


@dataclass
class Tally:
    """Counts over applications.

    Attributes
    ----------
    applications : that were accepted
    refused : descriptions that were not, by the finding
    left_out : by the reason: applications of which something is not simulated
    played, calls : applications and calls that were compared with a player
    verdicts : limits that an analysis says are met, and what was observed of them
    observed, bounded : by construct, the number of observed maxima, and of those with a bound
    ratios : by construct, observed maximum divided by bound
    """

    applications: int = 0
    refused: Counter[str] = field(default_factory=Counter)
    left_out: Counter[str] = field(default_factory=Counter)
    played: Counter[str] = field(default_factory=Counter)
    calls: Counter[str] = field(default_factory=Counter)
    verdicts: Counter[str] = field(default_factory=Counter)
    observed: Counter[str] = field(default_factory=Counter)
    bounded: Counter[str] = field(default_factory=Counter)
    ratios: defaultdict[str, list[float]] = field(default_factory=lambda: defaultdict(list))

    def add(self, constructs: Iterable[str], observed: float, bound: int | None) -> None:
        """One more maximum that was observed."""
        for name in constructs:
            self.observed[name] += 1
            if bound is not None:
                self.bounded[name] += 1
                self.ratios[name].append(float(observed / bound) if bound else 1.0)

    def add_all(self, other: Tally) -> None:
        """What was counted elsewhere."""
        self.applications += other.applications
        for name in ("refused", "left_out", "played", "calls", "verdicts", "observed", "bounded"):
            getattr(self, name).update(getattr(other, name))
        for construct, found in other.ratios.items():
            self.ratios[construct].extend(found)

    def rows(self) -> list[tuple[str, int, float, float | None, float | None]]:
        """By construct: observed maxima, the share of them with a bound, and median and maximum of observed/bound."""
        return [
            (
                name,
                count,
                self.bounded[name] / count,
                median(self.ratios[name]) if self.ratios[name] else None,
                max(self.ratios[name], default=None),
            )
            for name, count in sorted(self.observed.items())
        ]

    def table(self) -> str:
        """The rows as text."""
        lines = [f"{'construct':42} {'observed':>9} {'bounded':>8} {'median':>7} {'max':>6}"]
        for name, count, share, middle, most in self.rows():
            shown = ("-" if value is None else f"{value:.3f}" for value in (middle, most))
            lines.append(f"{name:42} {count:9} {share:8.0%} {next(shown):>7} {next(shown):>6}")
        return "\n".join(lines)

    def summary(self) -> str:
        """What was examined."""
        lines = [f"{count:6} descriptions refused: {reason}" for reason, count in self.refused.most_common(5)]
        lines += [
            f"{count:6} applications of which something was not simulated: {reason}" for reason, count in self.left_out.items()
        ]
        lines += [f"{count:6} {kind} played, {self.calls[kind]} calls compared" for kind, count in self.played.items()]
        verdicts = ", ".join(f"{count} {verdict}" for verdict, count in self.verdicts.items())
        return "\n".join([*lines, f"{self.applications} applications analysed and simulated; limits: {verdicts}"])

    def short_table(self) -> str:
        """The rows of quantities, kinds of loops and wires, as Markdown."""
        lines = ["| construct | observed | with a bound | observed/bound, median | maximum |", "|---|---|---|---|---|"]
        for name, count, share, middle, most in self.rows():
            if name.startswith(("quantity: ", "loop: ", "wire: ")) or name == "all":
                shown = ("-" if value is None else f"{value:.2f}" for value in (middle, most))
                lines.append(f"| {name.removeprefix('quantity: ')} | {count} | {share:.0%} | {next(shown)} | {next(shown)} |")
        return "\n".join(lines)
