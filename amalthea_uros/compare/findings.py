"""What is reported of a comparison beside its rows: assumptions, refuted bounds, names and phases that nobody knows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros.compare.naming import Target
from amalthea_uros.compare.results import Agreement, Comparison
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.measure.series import Measurement
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import unstated_phases
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Time, time_text


def open_phases(system: System, settings: Settings) -> tuple[str, ...]:
    """What comes from outside with an unknown phase."""
    return tuple(dict.fromkeys(occurrence.source for occurrence in unstated_phases(system, settings.phases)))


def assumptions_of(
    measurement: Measurement, found: Sequence[Target], overheads: Mapping[str, Time], *predictions: object
) -> tuple[str, ...]:
    """The assumptions of the predictions, and which overheads and baselines are part of what is compared."""
    lost = dict.fromkeys(target.name for target in found if target.series.counts.lost and not target.reason)
    stated = [sentence for each in predictions for sentence in getattr(each, "assumptions", ())]
    if lost:
        stated.append(f"what was lost of {', '.join(lost)} may have taken longer than all that was measured")
    net = list(dict.fromkeys(series.name for series in measurement.series if series.baseline is not None))
    again = list(dict.fromkeys(target.series.name for target in found if target.is_with_baseline))
    if subtracted := [name for name in net if name not in again]:
        stated.append(f"the mean of a baseline was subtracted from what was measured of {', '.join(subtracted)}")
    if again:
        stated.append(f"the baseline of {', '.join(again)} was added again, because the predicted times include an overhead")
    if not net and not overheads:
        stated.append("no baseline was subtracted from the measured times, and no overhead was added to the predicted ones")
    for name, overhead in overheads.items():
        whose = name or "every process"
        stated.append(f"{time_text(overhead)} of overhead were added to the predicted execution and response times of {whose}")
    return tuple(dict.fromkeys(stated))


# Findings.


def findings_of(comparison: Comparison, found: Sequence[Target], phases: Sequence[str]) -> Iterator[Finding]:
    """The bounds that were exceeded, names that the model does not have, and phases that are open."""
    yield from _refutations(comparison)
    yield from _unknown_names(found)
    for row in comparison.distributions:
        if row.is_hidden:
            what = f"{row.quantity.replace('_', ' ')} of {row.object!r}"
            share = f"{float(row.distance.value):.2g}"
            message = f"the mean {what} agrees, but not its distribution (Kolmogorov-Smirnov distance {share})"
            yield Finding("CMP003", Severity.WARNING, message, help="Compare the histograms.", object=row.object)
    if phases:
        yield _unknown_phases(comparison, phases)
    if not comparison.compared:
        message = "nothing was compared: no measured quantity is predicted"
        yield Finding("CMP005", Severity.ERROR, message, help="Say with --map or --as what the measured objects are.")


def _unknown_phases(comparison: Comparison, phases: Sequence[str]) -> Finding:
    names = ", ".join(map(repr, phases))
    is_range = comparison.seed is not None or any(row.predicted_range for row in comparison.rows)
    what = "are ranges over several phases" if is_range else "are bounds, and no means, because there are too many phases"
    message = f"the phase of {names} is unknown: predictions that depend on it {what}"
    return Finding("CMP004", Severity.WARNING, message, help="State it with --phase NAME=TIME to compare more strictly.")


def _refutations(comparison: Comparison) -> Iterator[Finding]:
    """A finding for each quantity that was measured beyond its bounds."""
    refuted: dict[tuple[str, str], list[str]] = {}
    for row in comparison.rows:
        if row.verdict is Agreement.REFUTED:
            bound = f"{row.reason} of {time_text(row.predicted or 0)}"
            refuted.setdefault((row.object, row.quantity), []).append(
                f"{row.statistic} {time_text(row.measured or 0)}, {bound}"
            )
    for (name, quantity), found in refuted.items():
        message = f"the model is wrong: the {quantity.replace('_', ' ')} of {name!r} was measured beyond its bounds: {'; '.join(found)}"
        yield Finding("CMP001", Severity.ERROR, message, help=_REFUTED, object=name)


_REFUTED = (
    "Correct execution times, periods or overheads of the model. If the clock of the trace is less exact than its steps, say so with "
    "--uncertainty TIME."
)


def _unknown_names(found: Sequence[Target]) -> Iterator[Finding]:
    counts = Counter(target.series.name for target in found if target.is_unknown)
    reasons = {target.series.name: target.reason for target in found if target.is_unknown}
    for name in counts:
        yield Finding("CMP002", Severity.WARNING, reasons[name], object=name)
