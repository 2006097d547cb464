"""The names that may be meant by an unknown one: close matches, in limited time."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from amalthea_uros._internal.records import dataclass

#: Longer names are not compared, because the time of a comparison grows with the product of the lengths.
MAX_LENGTH = 200
#: More suggestions help nobody.
_MOST = 3


def similar(name: str, known: Iterable[str], count: int = 1, cutoff: float = 0.6) -> list[str]:
    """The known names most similar to another one, whatever their case, the most similar first.

    Parameters
    ----------
    cutoff : how similar they are at least, from 0 to 1

    Examples
    --------
    >>> similar("tim-wiat", ["TIM-UNIT", "TIM-WAIT", "INC-CO-KIND"])
    ['TIM-WAIT']
    """
    from difflib import get_close_matches  # only after a mistake

    if len(name) > MAX_LENGTH:
        return []
    folded: dict[str, str] = {}
    for one in known:
        if len(one) <= MAX_LENGTH:
            folded.setdefault(one.casefold(), one)
    return [folded[match] for match in get_close_matches(name.casefold(), folded, n=count, cutoff=cutoff)]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The question whether one of the most similar names was meant, or else one that only has a further part; "" if there is none.

    >>> did_you_mean("Control", ["Executor", "Control_Callback"])
    "did you mean 'Control_Callback'?"
    >>> did_you_mean("anlyze", ["analyze", "build"]), did_you_mean("x", ["analyze", "build"])
    ("did you mean 'analyze'?", '')
    """
    every = list(known)
    near = similar(name, every, count=_MOST) or [each for each in every if each.startswith(f"{name}_")][:_MOST]
    return f"did you mean {' or '.join(map(repr, near))}?" if near else ""


@dataclass(slots=True)
class Suggestions:
    """Suggestions for many unknown names; the last ones get none where all of them would take longer than reading.

    Attributes
    ----------
    comparisons : of two names that are still made
    """

    comparisons: int = 20_000

    def nearest(self, name: str, known: Collection[str], cutoff: float = 0.6) -> str:
        """The most similar known name, "" if none is similar."""
        self.comparisons -= len(known)
        return next(iter(similar(name, known, cutoff=cutoff)), "") if self.comparisons > 0 else ""

    def advice(self, name: str, known: Collection[str], cutoff: float = 0.6) -> str:
        """The most similar known name as the begin of a help line, "" if none is similar."""
        near = self.nearest(name, known, cutoff)
        return f"Did you mean {near!r}? " if near else ""
