"""What a description or a model leaves open, so that results are missing."""

from __future__ import annotations

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.missing_values import MissingValues, lacks_values, missing_values
from amalthea_uros.services.changed import ChangedSystem


def missing_from(changed: ChangedSystem, analysis: Analysis) -> MissingValues | None:
    """What can be stated so that more processes have a response time; None if nothing helps."""
    if not lacks_values(changed.system, analysis):
        return None
    source = changed.source
    if source is None:
        from amalthea_uros.design.changes.origin import SystemOrigin

        return missing_values(SystemOrigin(Configuration(changed.system, changed.settings)), analysis, changed.changes)
    from amalthea_uros.design.description.unset import unset_times

    return missing_values(source, analysis, changed.changes, tuple(unset_times(source)))
