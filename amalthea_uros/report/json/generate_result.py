"""Files that were generated for the build of the firmware, for programs."""

from __future__ import annotations

from typing import Any

from amalthea_uros.report.findings import finding_json
from amalthea_uros.report.json.build_result import memory_json
from amalthea_uros.services.generate import GenerateResult
from amalthea_uros.uros.generated_options import values_of


def content(result: GenerateResult) -> dict[str, Any]:
    """The files with their contents, the options, and the memory with them."""
    return {
        "description": str(result.description),
        "folder": None if result.folder is None else str(result.folder),
        "files": [{"name": name, "text": text} for name, text in result.texts.items()],
        "options": [
            {
                "option": option.name,
                "package": option.package,
                "generated": option.text(value),
                "described": option.text(option.available),
                "needed": option.needed,
                "unit": option.unit,
                "counts": option.counts,
            }
            for option, value in values_of(result.assembly.options)
        ],
        "memory": memory_json(result.memory),
        "findings": [finding_json(finding) for finding in result.findings],
    }
