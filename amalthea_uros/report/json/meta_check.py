"""A `colcon.meta` compared with an application, for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.report.findings import finding_json
from amalthea_uros.services.generate import MetaCheck


def content(result: MetaCheck) -> dict[str, Any]:
    """The findings."""
    return {
        "description": str(result.description),
        "checked": str(result.path),
        "is_fine": result.is_fine,
        "findings": [finding_json(finding) for finding in result.findings],
    }
