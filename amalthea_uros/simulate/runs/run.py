"""Simulations of whole systems."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from typing import TypeAlias

from amalthea_uros.executors.semantics.steps import with_steps
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.metrics.kept_values import KeptValues
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.program.build import build_program
from amalthea_uros.simulate.program.host_system import with_host
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.simulate.runs.evaluation import RunEvaluation
from amalthea_uros.simulate.runs.execution import SimulationRun
from amalthea_uros.timing.activation.releases import with_first_arrivals
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.trace.sinks import TraceSink
from amalthea_uros.trace.table import Entity

#: Opens what the events of a run are written to, when the entities are known.
OpenSink: TypeAlias = "Callable[[Sequence[Entity]], TraceSink]"


def simulate_system(
    system: System, options: Options, sinks: Sequence[OpenSink] = (), kept: KeptValues | None = None
) -> Simulation:
    """Simulate a system once.

    Processes and chains that cannot be simulated are findings; the others are simulated as if they did not exist.

    Parameters
    ----------
    sinks : for the events of `options.traced`
    kept : keeps single values
    """
    steps = with_host(with_steps(system))
    context = TimingContext.of_scheduling(with_first_arrivals(steps, options.settings.phases), options.settings)
    program = build_program(context, options)
    run = SimulationRun(context, options, program, kept)
    with ExitStack() as stack:
        run.execute([stack.enter_context(open_sink(program.entities)) for open_sink in sinks])
    result = RunEvaluation(run).result()
    # Run and driver refer to each other: the memory of each run would be kept until garbage is collected, which is rare.
    run.driver.memory = []
    return result
