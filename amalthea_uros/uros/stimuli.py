"""Stimuli that tasks share: one for each period and offset."""

from __future__ import annotations

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.stimuli import Periodic, Stimulus
from amalthea_uros.units import Time, time_text


class StimulusPool:
    """The stimuli of a system, as tasks ask for them."""

    def __init__(self) -> None:
        self._found: dict[str, Stimulus] = {}

    @property
    def stimuli(self) -> tuple[Stimulus, ...]:
        """All stimuli that were asked for."""
        return tuple(self._found.values())

    def add(self, stimulus: Stimulus) -> str:
        """Add one that belongs to a single process, and give its name."""
        self._found[stimulus.name] = stimulus
        return stimulus.name

    def periodic(self, period: Time, offset: Time, origin: Location | None) -> str:
        """The name of the stimulus with a period and an offset."""
        name = (f"every_{time_text(period)}" + (f"_from_{time_text(offset)}" if offset else "")).replace(" ", "_")
        return self.add(self._found.get(name) or Periodic(name=name, period=period, offset=offset, origin=origin))
