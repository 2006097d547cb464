"""The public names of the library, in the groups of the rooms that they come from."""

from __future__ import annotations

from collections.abc import Iterator

import amalthea_uros as amuros

#: Title of a group -> the rooms and modules that its names come from; a module counts more than its room.
GROUPS = {
    "Files, and what the commands do": ("services", "report"),
    "From measurements to better designs": (
        *("measure", "services.measure", "services.compare", "compare"),
        *("services.calibrate", "compare.calibration", "design.optimize", "services.optimize", "services.sweep"),
    ),
    "AMALTHEA models": ("xmi", "metamodel", "bridge"),
    "Descriptions": ("uros",),
    "Analysis": ("analyze",),
    "Simulation": ("simulate", "trace"),
    "Systems": ("perf", "timing", "design.changes"),
}
OTHERS = "Findings, errors and quantities"


def api_lists() -> str:
    """A section for each group, with the documentation of each name."""
    return "\n\n".join("\n\n".join(_section(title)) for title in (*GROUPS, OTHERS)) + "\n"


def _section(title: str) -> Iterator[str]:
    yield f"## {title}"
    for name, home in sorted(amuros._HOMES.items(), key=lambda item: (item[0][0].isupper(), item[0])):
        if _group(home) == title:
            yield f"::: amalthea_uros.{home}.{name}"


def _group(home: str) -> str:
    """The group of a module: that of the longest start of its name that one of them lists."""
    found = {listed: title for title, modules in GROUPS.items() for listed in modules if f"{home}.".startswith(f"{listed}.")}
    return found[max(found, key=len)] if found else OTHERS
