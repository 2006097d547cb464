"""How many messages are lost on a wire, as an assumption about it."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Annotated, Any, Self, TypeAlias

from amalthea_uros import units
from amalthea_uros._internal.records import dataclass
from amalthea_uros.spec.fields import Before, examines
from amalthea_uros.spec.section import Shorthand
from amalthea_uros.spec.values import editor_schema, problem, unexpected

#: More are no exception; each takes a place in the memory of a simulation.
_MOST = 1000
_BILLION = 10**9
_COUNT = r"(?a)\s*(\d{1,9})\s+per\s+(\S.*?)\s*"
_SHARE = r"(?a)\s*(\d{1,3}(?:\.\d{1,9})?)\s*%\s*"
_EXPECTED = "expected a number in a time such as '1 per 10 s', or a probability of each message such as '0.1 %'"


@dataclass(frozen=True, slots=True)
class LossRate:
    """At most a number of messages in any time of some length, or each message with a probability.

    Attributes
    ----------
    window : 0 for a probability
    per_billion : the probability
    """

    count: int = 0
    window: units.Time = 0
    per_billion: int = 0

    def __str__(self) -> str:
        if self.window:
            return f"{self.count} per {units.time_text(self.window)}"
        return f"{units.number_text(Fraction(self.per_billion * 100, _BILLION))} %"


def _loss_rate(value: Any) -> LossRate:
    text = value if isinstance(value, str) else ""
    if counted := re.fullmatch(_COUNT, text):
        try:
            window = units.parse_time(counted[2])
        except ValueError as error:
            raise problem(str(error)) from None
        if not 1 <= int(counted[1]) <= _MOST or window <= 0:
            raise unexpected(f"expected 1 to {_MOST:,} messages in a time above zero")
        return LossRate(count=int(counted[1]), window=window)
    if stated := re.fullmatch(_SHARE, text):
        share = Fraction(stated[1]) * _BILLION / 100
        if not 1 <= share < _BILLION:
            raise unexpected("expected a probability above 0 % and below 100 %")
        return LossRate(per_billion=int(share))
    raise unexpected(_EXPECTED)


_Rate: TypeAlias = Annotated[
    LossRate,
    Before(_loss_rate),
    editor_schema(
        _EXPECTED,
        type="string",
        pattern=r"^\s*([0-9]+\s+per\s+[0-9.].*|[0-9]{1,3}([.][0-9]+)?\s*%)\s*$",
        examples=["1 per 10 s", "0.1 %"],
    ),
]


class LossesSection(Shorthand):
    """Messages that are lost: a number in a time or a probability, for both directions or for one."""

    shorthand = ("both",)
    plain_value = "Of the messages in both directions together."

    both: _Rate | None = None
    """Of the messages in both directions together: `1 per 10 s` for at most one in any 10 s, or `0.1 %` for the probability of each."""
    to_controller: _Rate | None = None
    """Of those to the controller alone."""
    to_agent: _Rate | None = None
    """Of those to the agent alone."""

    @examines
    def _is_one_or_the_other(self) -> Self:
        if self.both is not None and (self.to_controller is not None or self.to_agent is not None):
            raise problem("'both' is for both directions together; state either it or the directions")
        if self.both is None and self.to_controller is None and self.to_agent is None:
            raise problem("state 'both', 'to_controller' or 'to_agent'")
        return self
