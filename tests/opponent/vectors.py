"""The published systems with every construct, and the facts about them."""

from __future__ import annotations

import json
from typing import Any

import pytest
from opponent.systems import PlainSystem
from support import SHARED

CONSTRUCTS = SHARED / "vectors" / "constructs"

needs_vectors = pytest.mark.skipif(not CONSTRUCTS.exists(), reason="the vectors are not at hand")


def plain_systems() -> dict[str, PlainSystem]:
    """The systems by their file names."""
    return dict(json.loads((CONSTRUCTS / "systems.json").read_text()))


def facts() -> dict[str, dict[str, Any]]:
    """What is known of the systems, by their file names."""
    return {entry["file"]: entry for entry in json.loads((CONSTRUCTS / "facts.json").read_text())}
