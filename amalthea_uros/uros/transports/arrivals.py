"""When messages are queued."""

from __future__ import annotations

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.stimuli import Periodic, RelativePeriodic, Stimulus
from amalthea_uros.units import Time


def arrivals(name: str, interval: Time, jitter: Time = 0, origin: Location | None = None) -> Stimulus:
    """Messages that come after a minimum time, each of which can be late.

    Messages that are sent less often are never denser than those that are sent after exactly that time.
    """
    if jitter:
        late = Uniform(lower=0, upper=jitter)
        return Periodic(name=name, period=interval, jitter=late, origin=origin)
    distance = Uniform(lower=interval, upper=interval)
    return RelativePeriodic(name=name, distance=distance, has_maximum=False, origin=origin)
