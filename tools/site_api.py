"""The public names of the library, in the groups of the rooms that they come from."""

from __future__ import annotations

from collections.abc import Iterator

import amalthea_uros as amuros

#: Room -> title of its group; the names of a room that is not listed are in the last group.
GROUPS = {
    "services": "Files, and what the commands do",
    "xmi": "AMALTHEA models",
    "metamodel": "AMALTHEA models",
    "bridge": "AMALTHEA models",
    "uros": "Descriptions",
    "analyze": "Analysis",
    "simulate": "Simulation",
    "trace": "Simulation",
    "perf": "Systems",
    "timing": "Systems",
}
OTHERS = "Findings, errors and quantities"


def api_lists() -> str:
    """A section for each group, with the documentation of each name."""
    titles = [*dict.fromkeys(GROUPS.values()), OTHERS]
    return "\n\n".join("\n\n".join(_section(title)) for title in titles) + "\n"


def _section(title: str) -> Iterator[str]:
    yield f"## {title}"
    for name, home in sorted(amuros._HOMES.items(), key=lambda item: (item[0][0].isupper(), item[0])):
        if GROUPS.get(home.partition(".")[0], OTHERS) == title:
            yield f"::: amalthea_uros.{home}.{name}"
