"""Problems for solvers, judged by the analysis alone."""

from collections.abc import Callable, Sequence
from fractions import Fraction

from amalthea_uros.analyze.results import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.changes.apply import apply
from amalthea_uros.changes.key import Configuration
from amalthea_uros.optimize.candidate import Candidate
from amalthea_uros.optimize.problem import Evaluation, Feasibility, Goal, Problem
from amalthea_uros.optimize.space import Space
from amalthea_uros.perf.system import System
from amalthea_uros.timing.settings import Settings

Measure = Callable[[Analysis], Fraction | int | None]


def problem_of(system: System, space: Space, measure: Measure | None = None, settings: Settings | None = None) -> Problem:
    """The problem to meet all limits, and to minimise something.

    Parameters
    ----------
    measure : by default the number of changes
    """
    configuration = Configuration(system, settings or Settings())

    def configure(design: Candidate) -> Configuration:
        return apply(*configuration, design)

    def evaluate(designs: Sequence[Candidate]) -> list[Evaluation]:
        return [judged(design, analyze_system(*configure(design)), measure) for design in designs]

    goal = Goal(name="value" if measure else "changes")
    return Problem(present=configuration, space=space, goals=(goal,), configure=configure, evaluate=evaluate)


def judged(design: Candidate, analysis: Analysis, measure: Measure | None) -> Evaluation:
    """What the analysis says of a design."""
    summary = analysis.summary
    feasible = Feasibility.NO if summary.missed else Feasibility.UNKNOWN if summary.unknown else Feasibility.YES
    value = measure(analysis) if measure else len(design)
    late = {each.name: max(0, -each.margin) for each in analysis.processes if each.margin is not None and each.margin < 0}
    return Evaluation(
        candidate=design,
        feasible=feasible,
        violations=late,
        values=(None if value is None else Fraction(value),),
        is_exact=True,
    )
