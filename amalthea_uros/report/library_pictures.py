"""Pictures for callers of the library: objects that notebooks display and that can be saved."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass
from amalthea_uros.compare.results import Comparison
from amalthea_uros.design.campaign.sweeps import SweepResult
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.series import Measurement
from amalthea_uros.names import require
from amalthea_uros.report import result_pictures
from amalthea_uros.report.pictures import simulation as drawn
from amalthea_uros.report.pictures.pareto import draw_pareto
from amalthea_uros.services.files import save_text
from amalthea_uros.services.optimize import Optimization
from amalthea_uros.services.simulate import SimulationResult
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.timing.basics.stated_times import TimeLike, stated_time

#: The part of a run that is shown, such as ("10 ms", "20 ms").
WindowLike = tuple[TimeLike, TimeLike]


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture; a notebook displays it.

    Attributes
    ----------
    svg : its text, which needs nothing outside of itself
    """

    svg: str

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: StrPath) -> None:
        """Write it to a file that ends with .svg.

        Raises
        ------
        InvalidArgumentError : another suffix.
        WriteError : the file cannot be written.
        """
        if Path(path).suffix.lower() != ".svg":
            raise InvalidArgumentError(f"{str(path)!r} does not end with .svg, the format of pictures")
        save_text(path, self.svg)

    def __repr__(self) -> str:
        return f"<Picture: {len(self.svg):,} characters of SVG>"


def gantt(
    simulation: Simulation | SimulationResult,
    *,
    process: str | None = None,
    chain: str | None = None,
    window: WindowLike | None = None,
) -> Picture:
    """The jobs of all processes in a part of a run.

    >>> gantt(simulate("app.yaml", "1 s")).save("gantt.svg")  # doctest: +SKIP

    Parameters
    ----------
    process, chain, window : one of them chooses the part: the longest response time of a process, the longest latency of a chain, or
        from when to when; by default, around the job that comes closest to its deadline

    Raises
    ------
    InvalidArgumentError : nothing was observed there, or something has another name.
    """
    result = _with_system(simulation)
    chosen = [each for each in (process, chain, window) if each is not None]
    if len(chosen) > 1:
        raise InvalidArgumentError("process, chain and window each choose what is shown; use only one of them")
    require("process", [] if process is None else [process], result.simulation.processes.names)
    require("chain", [] if chain is None else [chain], result.simulation.chains.names)
    return Picture(drawn.gantt_picture(result, window=_window(result, window), process=process, chain=chain))


def timeline(simulation: Simulation | SimulationResult, process: str, *, window: WindowLike | None = None) -> Picture:
    """The states of a process in a part of a run, by default around its longest response time; errors as for `gantt`."""
    result = _with_system(simulation)
    require("process", [process], result.simulation.processes.names)
    return Picture(drawn.timeline_picture(result, process, _window(result, window)))


def histogram(result: Simulation | SimulationResult | Measurement, name: str) -> Picture:
    """How often which time occurred.

    Parameters
    ----------
    result : of a simulation or a measurement
    name : of a process, a chain or a measured object, or with a quantity, such as "Task.net_execution_time"

    Raises
    ------
    InvalidArgumentError : it was not observed.
    """
    if isinstance(result, Measurement):
        return Picture(result_pictures.histogram_picture(result, name))
    return Picture(drawn.histogram_picture(_with_system(result), name))


def picture(result: Comparison | SweepResult | Optimization, quantity: str | None = None) -> Picture:
    """A result as a picture: a comparison, a quantity of a sweep over the swept values, or the Pareto front of a search with two goals.

    Raises
    ------
    InvalidArgumentError : it cannot be drawn, or a sweep has no such quantity.
    """
    match result:
        case Comparison():
            return Picture(result_pictures.comparison_picture(result))
        case SweepResult():
            if quantity is None:
                raise InvalidArgumentError(
                    "a sweep has several quantities; name one, e.g. picture(result, 'T1.worst_case_response_time')"
                )
            return Picture(result_pictures.sweep_picture(result, quantity))
        case Optimization():
            return Picture(draw_pareto(result))
    raise TypeError(
        f"expected a comparison, a sweep or an optimization, not {type(result).__name__}; "
        "gantt, timeline and histogram draw simulations, histogram draws measurements"
    )


def _with_system(simulation: Simulation | SimulationResult) -> SimulationResult:
    if isinstance(simulation, SimulationResult):
        return simulation
    if not isinstance(simulation, Simulation):
        raise TypeError(f"expected the result of simulate(), not {type(simulation).__name__}")
    if simulation.origin is None:
        raise InvalidArgumentError("the system of this simulation was not kept; simulate it with amuros.simulate()")
    origin = simulation.origin
    return SimulationResult(paths=(), system=origin.system, options=origin.options, simulation=simulation, findings=())


def _window(result: SimulationResult, window: WindowLike | None) -> drawn.Window | None:
    if window is None:
        return None
    part = stated_time("the start of the window", window[0], least=0), stated_time("the end of the window", window[1], least=1)
    drawn.check_window_of(result.options, part)
    return part
