"""How measured values become those of a description."""

from __future__ import annotations

from enum import StrEnum
from fractions import Fraction

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import InvalidArgumentError


class Form(StrEnum):
    """What is written for measured execution times: bounds, bounds with the mean, or a histogram."""

    BOUNDS = "bounds"
    MEAN = "mean"
    HISTOGRAM = "histogram"


#: The times in the agent that can be fitted.
AGENT_KEYS = ("agent.to_controller", "agent.to_host")
FIT_FORM = "agent[.to_controller|.to_host]=CHAIN"


@dataclass(frozen=True, slots=True)
class AgentFit:
    """Times in the agent that are chosen so that a chain takes as long as was measured.

    Attributes
    ----------
    keys : of `AGENT_KEYS`
    chain : whose round trips were measured at the host
    """

    keys: tuple[str, ...]
    chain: str


def parse_fit(text: str) -> AgentFit:
    """A fit as it is written.

    >>> parse_fit("agent.to_host=round-trip")
    AgentFit(keys=('agent.to_host',), chain='round-trip')

    Raises
    ------
    ValueError : the text has another form.
    """
    what, _, chain = (part.strip() for part in text.partition("="))
    keys = tuple(key for key in AGENT_KEYS if what in (key, "agent"))
    if not (keys and chain):
        raise ValueError(f"{text!r} is not of the form {FIT_FORM}; an example: 'agent=round-trip'")
    return AgentFit(keys, chain)


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationOptions:
    """How measured values become those of a description.

    Attributes
    ----------
    margin : by which share measured minima are lowered and maxima raised, for bounds
    tighten : whether values of the description that are wider than the measurement are narrowed
    fits : times that are fitted to what was measured as a whole; nothing is fitted that is not named
    judge_on : the share of the values, the last ones, that are not used, but must be within what is written
    """

    form: Form = Form.BOUNDS
    margin: Fraction = Fraction(1, 5)
    tighten: bool = False
    judge_on: Fraction = Fraction(0)
    fits: tuple[AgentFit, ...] = ()

    def __post_init__(self) -> None:
        if self.margin < 0:
            raise InvalidArgumentError(f"the margin {float(self.margin):.4g} is negative; expected 0 or more, e.g. 20%")
        if not 0 <= self.judge_on < 1:
            raise InvalidArgumentError(
                f"cannot judge on {float(self.judge_on):.4g} of the values; expected less than all, e.g. 30%"
            )
