"""Stimuli that tasks share: one for each period and offset."""

from __future__ import annotations

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.stimuli import Periodic, Stimulus
from amalthea_uros.units import Time, time_text


class StimulusRegistry:
    """The stimuli of a system, created as processes need them."""

    def __init__(self) -> None:
        self._by_name: dict[str, Stimulus] = {}

    @property
    def stimuli(self) -> tuple[Stimulus, ...]:
        """All stimuli in the order of their creation."""
        return tuple(self._by_name.values())

    def add(self, stimulus: Stimulus) -> str:
        """Add the stimulus of a single process, and return its name."""
        self._by_name[stimulus.name] = stimulus
        return stimulus.name

    def periodic(self, period: Time, offset: Time, origin: Location | None) -> str:
        """The name of the stimulus with a period and an offset; created on first use."""
        name = (f"every_{time_text(period)}" + (f"_from_{time_text(offset)}" if offset else "")).replace(" ", "_")
        return self.add(self._by_name.get(name) or Periodic(name=name, period=period, offset=offset, origin=origin))
