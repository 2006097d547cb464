"""What the messages of findings name, to see whether two findings are about the same thing."""

from __future__ import annotations

import re

from amalthea_uros.diagnostics import Finding

_QUOTED = re.compile(r"""['"<]([^'"<>]+)['">]""")

#: The separator between the name and the class of an object in a reference.
_TYPE = "?type="


def names_in(finding: Finding) -> frozenset[str]:
    """What a message names in quotes; where it quotes references, only the objects to which these refer."""
    quoted = _QUOTED.findall(finding.message)
    references = [name.partition(_TYPE)[0] for name in quoted if _TYPE in name]
    return frozenset(references or quoted)


def names_of_events(names: frozenset[str]) -> frozenset[str]:
    """Names, and what comes before their last underscore: an event `Sense_start` is one of the function `Sense`."""
    return names | {name.rpartition("_")[0] for name in names if "_" in name.strip("_")}


def likeness(one: frozenset[str], other: frozenset[str], of_events: bool = False) -> float:
    """Which part of the names of two findings is the same, 1 if all names of one of them are.

    Parameters
    ----------
    of_events : a function is the same as one of its events
    """
    if not one or not other:
        return 0.0
    more = names_of_events if of_events else frozenset[str]
    return max(len(one & more(other)) / len(one), len(other & more(one)) / len(other))
