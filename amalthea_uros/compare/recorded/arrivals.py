"""How often the messages of a topic were published, by the source stamps of those that were taken."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import ceil

from amalthea_uros._internal.records import dataclass
from amalthea_uros.trace.ctf.ros2_objects import RosSubscription
from amalthea_uros.units import NANOSECOND, SECOND, Frequency, Time
from amalthea_uros.uros.application.callbacks import interval_of_rate

#: Rates are rounded up to so many parts of a hertz.
_PARTS = 1000


@dataclass(frozen=True, slots=True)
class RecordedArrivals:
    """Messages of a topic.

    Attributes
    ----------
    jitter : the least one with which messages of this rate are published as these were
    """

    rate: Frequency
    jitter: Time
    count: int


def arrivals_of(subscriptions: Iterable[RosSubscription]) -> RecordedArrivals | None:
    """The mean rate with the jitter that it needs; None if fewer than two messages were taken.

    A message that several subscriptions have taken has the same stamp in each.
    """
    stamps = sorted({stamp for each in subscriptions for stamp in each.stamps})
    if len(stamps) < 2:
        return None
    mean = Fraction((len(stamps) - 1) * SECOND, (stamps[-1] - stamps[0]) * NANOSECOND)
    rate = Fraction(ceil(mean * _PARTS), _PARTS)
    interval = interval_of_rate(rate)
    if not interval:
        return None
    # Events fit an interval T and a jitter J if any n + 1 of them take at least nT - J.
    jitter, earliest = 0, 0
    for number, stamp in enumerate(stamps):
        ahead = number * interval - (stamp - stamps[0]) * NANOSECOND
        earliest = min(earliest, ahead)
        jitter = max(jitter, ahead - earliest)
    return RecordedArrivals(rate, jitter, len(stamps))
