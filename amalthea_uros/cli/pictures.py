"""The pictures that a user wants of a simulation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.services.simulate import SimulationPlan, SimulationResult


@dataclass(frozen=True, slots=True)
class Pictures:
    """Files for pictures.

    Attributes
    ----------
    timelines : of processes
    histograms : of processes, chains, or one of their quantities
    window : the part of the run that is drawn; None: around a job that is chosen for each picture
    """

    gantt: Path | None
    timelines: tuple[tuple[str, Path], ...]
    histograms: tuple[tuple[str, Path], ...]
    window: tuple[Time, Time] | None

    @property
    def paths(self) -> tuple[Path, ...]:
        """All files."""
        chart = () if self.gantt is None else (self.gantt,)
        return (*chart, *(path for _, path in self.timelines), *(path for _, path in self.histograms))

    def check(self, plan: SimulationPlan) -> None:
        """Refuse what cannot be drawn, before the simulation, which may take long.

        Raises
        ------
        InvalidArgumentError : a process, chain or quantity does not exist, or the window is after the end of the run.
        """
        if not self.paths:
            return
        from amalthea_uros.report.simulation_pictures import check_window_of, quantity_of
        from amalthea_uros.services.names import require

        require("process", (process for process, _ in self.timelines), plan.system.processes)
        for name, _ in self.histograms:
            quantity_of(name, plan.system)
        if self.window is not None:
            check_window_of(plan.options, self.window)

    def write(self, result: SimulationResult) -> None:
        """Draw and write all of them.

        Raises
        ------
        InvalidArgumentError : there is nothing to draw.
        WriteError : a file cannot be written.
        """
        if not self.paths:
            return
        from amalthea_uros.xmi.files import FileText, write_text

        for path, draw in self._drawings():
            write_text(path, FileText(draw(result)))

    def _drawings(self) -> Iterator[tuple[Path, Callable[[SimulationResult], str]]]:
        from amalthea_uros.report import simulation_pictures as draw

        if self.gantt is not None:
            yield self.gantt, partial(draw.gantt_picture, window=self.window)
        for process, path in self.timelines:
            yield path, partial(draw.timeline_picture, process=process, window=self.window)
        for name, path in self.histograms:
            yield path, partial(draw.histogram_picture, name=name)
