"""Best-case response times under fixed priorities.

After O. Redell and M. Sanfridson, "Exact best-case response time analysis of fixed priority scheduled tasks", ECRTS 2002: the
greatest fixed point of R = C + sum over higher priorities of C_j * (ceil(R / T_j) - 1), the interference that is unavoidable in R.
Tasks with jitter or without a maximum time between activations are ignored; then the value is a lower bound. It holds once all tasks
have been released: the first jobs of a system can run before other tasks have started.
"""

from __future__ import annotations

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.kernel import greatest_fixed_point
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.timing.basics.limits import LIMIT
from amalthea_uros.units import Time


def best_response(task: Task, higher: Interference) -> Time:
    """A lower bound of the response time once all tasks have been released; exact for periodic tasks with unknown offsets."""
    own, rows = task.demand.best, higher.rows
    if higher.best_rate >= 1 or not higher.is_countable:
        return own
    # There is no greater fixed point, because R <= C + rate * R.
    start = int(own / (1 - higher.best_rate)) + 1
    if start > LIMIT:
        return own
    return greatest_fixed_point(own, start, rows.periods, rows.best, higher.row_count)
