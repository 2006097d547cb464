"""What somebody may have meant by a name that is not known."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

#: More suggestions help nobody.
_MOST = 3


def nearest(name: str, known: Iterable[str], most: int = _MOST) -> list[str]:
    """The known names that are most similar to a name, whatever their case; the most similar one first.

    >>> nearest("tim-wiat", ["TIM-UNIT", "TIM-WAIT", "INC-CO-KIND"], most=1)
    ['TIM-WAIT']
    """
    folded: dict[str, str] = {}
    for one in known:
        folded.setdefault(one.casefold(), one)
    return [folded[match] for match in get_close_matches(name.casefold(), folded, n=most)]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The question whether one of the most similar names was meant, "" if none is similar.

    >>> did_you_mean("anlyze", ["analyze", "build"]), did_you_mean("x", ["analyze", "build"])
    ("did you mean 'analyze'?", '')
    """
    near = nearest(name, known)
    return f"did you mean {' or '.join(map(repr, near))}?" if near else ""
