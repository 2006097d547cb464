"""Which findings of a check are shown: those that nothing suppresses, one for each flaw."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings.accepted import fingerprint, is_suppressed, read_baseline
from amalthea_uros.findings.grouping import group
from amalthea_uros.findings.presentation import Presentation, present
from amalthea_uros.findings.targets import TARGETS
from amalthea_uros.validate import registry
from amalthea_uros.validate.selection import Selection
from amalthea_uros.validate.settings import CheckSettings


def accepted_by(settings: CheckSettings) -> Collection[str]:
    """The fingerprints of the findings that the baseline of settings accepts; InvalidArgumentError if it cannot be read."""
    try:
        return read_baseline(settings.baseline) if settings.baseline is not None else ()
    except ValueError as error:
        raise InvalidArgumentError(str(error)) from None


def not_suppressed(
    found: Sequence[Finding], selection: Selection, settings: CheckSettings, accepted: Collection[str]
) -> tuple[Finding, ...]:
    """The findings that are not suppressed in any way.

    Parameters
    ----------
    accepted : fingerprints of findings that a baseline accepts
    """
    findings = tuple(finding for finding in found if not (finding.rule in selection.ignored or is_suppressed(finding)))
    if accepted:
        of_flaws = presented(findings, selection, settings).accepted(accepted)
        findings = tuple(each for each in findings if each not in of_flaws and fingerprint(each) not in accepted)
    return findings if len(findings) == len(found) else _without_repeated(findings, found)


def presented(findings: Sequence[Finding], selection: Selection, settings: CheckSettings) -> Presentation:
    """The findings as they are shown; those about a target tool count if settings, profiles or selected rules ask for it."""
    selected = TARGETS if selection.selected else ()
    asked = {*settings.targets, *map(str, selection.profiles), *(target.name for target in selected)}
    return present(findings, asked)


def _without_repeated(findings: Sequence[Finding], found: Sequence[Finding]) -> tuple[Finding, ...]:
    """The findings without those of reading whose flaw a suppressed rule reports too: it must not come back in general terms.

    Parameters
    ----------
    findings : those of `found` that are not suppressed
    """
    kept = set(findings)
    repeated: set[Finding] = set()
    for flaw in group(found):
        rules = [finding for finding in flaw.same if registry.profile_of(finding.rule) is not None]
        if rules and kept.isdisjoint(rules):
            repeated.update(flaw.same)
    return tuple(finding for finding in findings if finding not in repeated)
