"""Two models compared by meaning."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.files import read_text, reading_once
from amalthea_uros._internal.limits import DESCRIPTION_SIZE
from amalthea_uros._internal.paths import StrPath, is_description
from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.shown import Shown
from amalthea_uros.bridge.extract import extract
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.timing_changes import TimingChange, timing_changes
from amalthea_uros.diagnostics import Finding
from amalthea_uros.difference.comparison import ModelChange, difference
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.versions import known_versions, newest_version
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.services.inputs import ModelInput, open_model
from amalthea_uros.services.migrate import migrate
from amalthea_uros.xmi.migrate.losses import announcements

if TYPE_CHECKING:
    from amalthea_uros.analyze.impact import Impact

#: What is said about a model that was migrated.
_MIGRATION = ("XMI008", "XMI009")


@dataclass(frozen=True, slots=True, kw_only=True)
class DiffResult(Brief, Shown):
    """The differences of two models.

    Attributes
    ----------
    old, new : the paths that were compared, or those of the documents of a model
    findings : which models were migrated in memory, so that models of different versions can be compared
    timing : the differences that matter for times, by object
    described : of two descriptions, the values and objects in which they differ; those of the built models follow from them
    impact : what all differences do to the results of an analysis; None if it was not requested
    """

    old: str
    new: str
    changes: tuple[ModelChange, ...]
    findings: tuple[Finding, ...] = ()
    timing: tuple[TimingChange, ...] = ()
    described: tuple[Difference, ...] = ()
    impact: Impact | None = None


@reading_once()
def diff(old: Model | StrPath, new: Model | StrPath, *, with_impact: bool = False) -> DiffResult:
    """Compare two models, or the files, folders or descriptions that hold them.

    If their versions differ, both are compared as models of the newest one.

    Parameters
    ----------
    with_impact : also analyze both, and compare the results

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    """
    opened = [ModelInput(model=one, findings=()) if isinstance(one, Model) else open_model([one]) for one in (old, new)]
    models = [one.model for one in opened]
    findings = [finding for model in models for finding in model.findings if finding.rule in _MIGRATION]
    if len({document.facts_version for model in models for document in model.documents}) > 1:
        for place, model in enumerate(models):
            if _can_be_migrated(model):
                result = migrate(model)
                models[place] = result.model
                findings += announcements(result.sets[0])
    changes = tuple(difference(*models))
    # Models without differences in meaning are the same system.
    systems = [one.system or extract(model).system for one, model in zip(opened, models, strict=True)] if changes else []
    return DiffResult(
        old=_name(old),
        new=_name(new),
        changes=changes,
        findings=tuple(dict.fromkeys(findings)),
        timing=timing_changes(*systems) if changes else (),
        described=_described(old, new),
        impact=_impact(systems) if with_impact else None,
    )


def _described(old: Model | StrPath, new: Model | StrPath) -> tuple[Difference, ...]:
    """The differences of two descriptions; empty if one of the files is a model."""
    sides = [Path(one) for one in (old, new) if not isinstance(one, Model) and is_description(one)]
    if len(sides) < 2:
        return ()
    from amalthea_uros.design.description.comparison import description_differences

    before, after = (read_text(side, DESCRIPTION_SIZE) for side in sides)
    return description_differences(before, sides[0], after, sides[1])


def _impact(systems: Sequence[System]) -> Impact:
    """The effect of the differences of two systems on the results; nothing if there are none."""
    from amalthea_uros.analyze.impact import Impact, impact
    from amalthea_uros.analyze.system import analyze_system

    if not systems:
        return Impact(rows=(), unchanged=0)
    return impact(*map(analyze_system, systems))


def _can_be_migrated(model: Model) -> bool:
    """Whether the model has older versions, and known ones only."""
    versions = {document.version for document in model.documents}
    return versions <= set(known_versions()) and versions != {newest_version()}


def _name(model: Model | StrPath) -> str:
    if isinstance(model, Model):
        return " ".join(str(document.path or "unsaved") for document in model.documents)
    return str(Path(model))
