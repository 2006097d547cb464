"""The public names of the library, in the groups of the rooms that they come from."""

from __future__ import annotations

from collections.abc import Iterator

import amalthea_uros as amuros

#: Page of `docs/api` -> the rooms and modules that its names come from; a module counts more than its room.
PAGES = {
    "files": ("services", "report"),
    "designs": (
        *("measure", "services.measure", "services.compare", "compare"),
        *("services.calibrate", "compare.calibration", "design.optimize", "services.optimize", "services.sweep", "design"),
    ),
    "models": ("xmi", "metamodel", "bridge"),
    "descriptions": ("uros",),
    "analysis": ("analyze", "executors"),
    "simulation": ("simulate", "trace"),
    "systems": ("perf", "timing", "design.changes", "design.taskset", "design.task_parameters", "design.random_tasksets"),
}
OTHERS = "findings"


def api_list(page: str) -> str:
    """The documentation of each name of a page."""
    return "\n\n".join(("## Reference", *_entries(page))) + "\n"


def _entries(page: str) -> Iterator[str]:
    for name, home in sorted(amuros._HOMES.items(), key=lambda item: (item[0][0].isupper(), item[0])):
        if _page(home) == page:
            yield f"::: amalthea_uros.{home}.{name}"


def _page(home: str) -> str:
    """The page of a module: that of the longest start of its name that one of them lists."""
    found = {listed: page for page, modules in PAGES.items() for listed in modules if f"{home}.".startswith(f"{listed}.")}
    return found[max(found, key=len)] if found else OTHERS
