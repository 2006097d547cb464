"""What the programs of all processes share."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.simulate.program.modes import Modes
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.program.watches import Watches


@dataclass(slots=True)
class Parts:
    """What the programs of all processes share.

    Attributes
    ----------
    processes, stimuli : their records
    queues : of messages with arrivals of their own, by process and source
    is_noted : whether events of runnables and labels are recorded
    watches : what is observed apart from jobs and chains
    """

    resources: Resources
    modes: Modes
    processes: dict[str, int]
    stimuli: dict[str, int]
    queues: dict[tuple[str, str], int]
    is_noted: bool
    watches: Watches
