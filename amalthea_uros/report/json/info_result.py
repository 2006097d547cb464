"""The summary of a model for programs."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from amalthea_uros.services.info import InfoResult


def content(result: InfoResult) -> dict[str, Any]:
    """Everything in the summary, under the names of its attributes."""
    return asdict(result.summary)
