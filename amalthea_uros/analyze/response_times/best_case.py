"""Best-case response times under fixed priorities.

After O. Redell and M. Sanfridson, "Exact best-case response time analysis of fixed priority scheduled tasks", ECRTS 2002: from above,
the greatest fixed point of R = C + sum over higher priorities of C_j * (ceil(R / T_j) - 1), the arrivals that cannot be avoided in R.
Activations that may be missing, or that jitter, are left out; then the value is a lower bound. It holds once all tasks have been
released: the first jobs of a system may run before others have started.
"""

from __future__ import annotations

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.kernel import least_response
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.timing.limits import LIMIT
from amalthea_uros.units import Time


def best_response(task: Task, higher: Interference) -> Time:
    """A lower bound of the response time behind the start; exact for periodic tasks whose offsets are not known."""
    own, rows = task.cost.best, higher.rows
    if higher.best_rate >= 1:
        return own
    # No fixed point lies above: there R is at most C + rate * R.
    start = int(own / (1 - higher.best_rate)) + 1
    if start > LIMIT:
        return own
    return least_response(own, start, rows.periods, rows.best, higher.count)
