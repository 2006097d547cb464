"""A response time, and what is claimed about it."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.units import Time


class Claim(StrEnum):
    """What is claimed about a value."""

    EXACT = "exact"
    BOUND = "bound"
    OBSERVED = "observed"


@dataclass(frozen=True, slots=True, kw_only=True)
class Response:
    """The response time of a task, from its activation to its end.

    Attributes
    ----------
    worst : None if there is no finite bound, for the `reason`
    best : minimum response time
    jobs : number of jobs of the busy window that were examined
    window : length of the busy window up to the end of the worst job
    completions : latest ends of the jobs of the busy window, from its start; empty if unknown
    terms : the parts of the worst case: own, interference, blocking; they add up to it
    is_overload : whether `worst` is None because, in the long run, more work is activated than can be executed
    """

    worst: Time | None
    best: Time
    method: str
    source: str
    claim: Claim = Claim.EXACT
    jobs: int = 1
    window: Time = 0
    completions: tuple[Time, ...] = ()
    terms: Mapping[str, Time] = field(default_factory=dict)
    reason: str = ""
    is_overload: bool = False
