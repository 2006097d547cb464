"""How long the way from a log to a better design takes: python benchmarks/closed_loop.py

CPU time, the least of several runs, on the application of the thesis.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import amalthea_uros as amuros
from amalthea_uros.design.optimize.space import designs_with
from amalthea_uros.services.optimize import plan_optimization

SAMPLES = Path(__file__).parents[1] / "samples"
ADVANCED = SAMPLES / "bodas-test-advanced.yaml"
LATENCY = "factor-to-output.max_reduced_reaction_time"


def least(run: Callable[[], object], runs: int = 5) -> float:
    """Seconds of CPU time of the fastest run."""
    found = []
    for _ in range(runs):
        started = time.process_time()
        run()
        found.append(time.process_time() - started)
    return min(found)


def main() -> None:
    """Print a line for each figure."""
    plan = plan_optimization(ADVANCED, limits=[f"{LATENCY}<11ms"])
    design = next(iter(designs_with(plan.problem.space, 1)))
    print(f"one design judged by the analysis: {1000 * least(lambda: plan.evaluator([design])):.1f} ms")
    for limit in ("11 ms", "5 ms"):
        seconds = least(lambda limit=limit: amuros.optimize(ADVANCED, limits=[f"{LATENCY}<{limit}"]))
        print(f"the smallest change that brings 20.029 ms below {limit}, with proof: {seconds:.2f} s")
    with TemporaryDirectory() as folder:
        log = Path(folder) / "run.log"
        amuros.simulate(ADVANCED, "30 s", trace_paths=[log])
        frames = log.read_text().count("\n")
        seconds = least(lambda: amuros.measure(log, markers=f"{log}.markers.yaml"), 3)
        print(
            f"candump log of {frames:,} frames read, paired and measured: {seconds:.2f} s, {frames / seconds:,.0f} frames a second"
        )
        table = amuros.measure(log, markers=f"{log}.markers.yaml")
        print(f"compared with analysis and a simulation as long: {least(lambda: amuros.compare(ADVANCED, table), 1):.2f} s")
    measured = amuros.measure(SAMPLES / "bodas-test-measured.log", markers=SAMPLES / "bodas-test-measured.markers.yml")
    seconds = least(lambda: amuros.calibrate(SAMPLES / "bodas-test-measured.yaml", measured))
    print(f"description calibrated by 9 measured values: {seconds:.2f} s")


if __name__ == "__main__":
    main()
