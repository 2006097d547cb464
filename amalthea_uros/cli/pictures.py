"""The pictures that a user wants of a simulation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.perf.system import System
    from amalthea_uros.services.simulate import SimulationResult
    from amalthea_uros.simulate.options import Options


@dataclass(frozen=True, slots=True)
class Pictures:
    """Files for pictures.

    Attributes
    ----------
    timelines : of processes
    histograms : of processes, chains, or one of their quantities
    window : the part of the run that is drawn; None: around a job that is chosen for each picture
    gantt_of, chain : the process or the chain that decides about the part for the Gantt chart
    """

    gantt: Path | None
    timelines: tuple[tuple[str, Path], ...]
    histograms: tuple[tuple[str, Path], ...]
    window: tuple[Time, Time] | None
    gantt_of: str | None = None
    chain: str | None = None

    @property
    def paths(self) -> tuple[Path, ...]:
        """All files."""
        return tuple(path for _, path in self.files)

    @property
    def files(self) -> tuple[tuple[str, Path], ...]:
        """All files with the options that name them."""
        chart = () if self.gantt is None else (("--gantt", self.gantt),)
        timelines = (("--timeline", path) for _, path in self.timelines)
        return (*chart, *timelines, *(("--histogram", path) for _, path in self.histograms))

    def check(self, system: System, options: Options) -> None:
        """Refuse what cannot be drawn, before the simulation, which may take long.

        Raises
        ------
        InvalidArgumentError : a process, chain or quantity does not exist, the window is after the end of the run, or two
            options contradict each other.
        """
        self._check_choice()
        if not self.paths:
            return
        from amalthea_uros.names import require
        from amalthea_uros.report.pictures.simulation import check_window_of, quantity_of

        require("process", (process for process, _ in self.timelines), system.processes)
        require("process", [self.gantt_of] if self.gantt_of is not None else [], system.processes)
        require("chain", [self.chain] if self.chain is not None else [], system.chains)
        for name, _ in self.histograms:
            quantity_of(name, system)
        if self.window is not None:
            check_window_of(options, self.window)

    def _check_choice(self) -> None:
        choices = {"--gantt-of": self.gantt_of, "--chain": self.chain}
        chosen = [option for option, value in choices.items() if value is not None]
        if chosen and self.gantt is None:
            raise InvalidArgumentError(f"{chosen[0]} chooses what --gantt FILE shows; add --gantt FILE")
        if self.window is not None and self.gantt is None and not self.timelines:
            raise InvalidArgumentError(
                "--window chooses what --gantt and --timeline show; add one of them, or use --trace-window"
            )
        if len(chosen) > 1 or (chosen and self.window is not None):
            others = [*chosen, *(["--window"] if self.window is not None else [])]
            raise InvalidArgumentError(f"{' and '.join(others)} each choose what --gantt shows; use only one of them")

    def write(self, result: SimulationResult) -> None:
        """Draw and write all of them.

        Raises
        ------
        InvalidArgumentError : there is nothing to draw.
        WriteError : a file cannot be written.
        """
        if not self.paths:
            return
        from amalthea_uros.services.files import save_text

        for path, draw in self._drawings():
            save_text(path, draw(result))

    def _drawings(self) -> Iterator[tuple[Path, Callable[[SimulationResult], str]]]:
        from amalthea_uros.report.pictures.simulation import gantt_picture, histogram_picture, timeline_picture

        if self.gantt is not None:
            yield self.gantt, partial(gantt_picture, window=self.window, process=self.gantt_of, chain=self.chain)
        for process, path in self.timelines:
            yield path, partial(timeline_picture, process=process, window=self.window)
        for name, path in self.histograms:
            yield path, partial(histogram_picture, name=name)
