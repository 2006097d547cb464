"""Groups, branches and loops."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Activity, Group, Loop, ProbabilitySwitch, Switch, Terminate
from amalthea_uros.simulate.kernel import layout, operations
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.program.image import JumpLabel, JumpTable

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.body import Body


def group(body: Body, activity: Group) -> None:
    """Activities one after the other, or in any order; perhaps without interruption."""
    if not activity.interruptible:
        body.code.add(operations.MASK)
        body.masks += 1
    if activity.ordered or len(activity.activities) < 2 or body.resources.options.mode is not SimulationMode.SAMPLED:
        body.activities(activity.activities)
    else:
        _in_any_order(body, activity.activities)
    if not activity.interruptible:
        body.code.add(operations.UNMASK)
        body.masks -= 1


def _in_any_order(body: Body, activities: Sequence[Activity]) -> None:
    image, total, done = body.resources.image, len(activities), JumpLabel()
    ordered, _ = image.items([0] * total)
    parts, _ = image.items([0] * total)
    record = image.record(layout.GROUP_SIZE, {layout.ORDERED_PARTS: ordered, layout.PARTS: parts, layout.PARTS_TOTAL: total})
    body.code.add(operations.SHUFFLE, record, body.resources.order(f"{body.place()} order"))
    following = body.code.here()
    body.code.add(operations.NEXT, record, done)
    labels = []
    for activity in activities:
        labels.append(body.code.here())
        body.activities([activity])
        body.code.add(operations.JUMP, following)
    body.code.tables.append(JumpTable(labels, ordered))
    body.code.mark(done)


def choose(body: Body, activity: ProbabilitySwitch) -> None:
    """One of several branches: drawn, or that with the longest or shortest demand."""
    if not activity.branches:
        return
    table, _ = body.resources.image.items([0] * len(activity.branches))
    labels, done, jump = [], JumpLabel(), JumpLabel()
    only = _extreme_branch(body, activity)
    if only is not None:
        body.code.add(operations.JUMP, jump)
    else:
        weights = [branch.weight for branch in activity.branches]
        body.code.add(operations.CHOOSE, body.resources.choice(weights, f"{body.place()} branch"), table)
    for index, branch in enumerate(activity.branches):
        labels.append(body.code.here())
        if index == only:
            body.code.mark(jump)
        body.activities(branch.activities)
        body.code.add(operations.JUMP, done)
    body.code.tables.append(JumpTable(labels, table))
    body.code.mark(done)


def _extreme_branch(body: Body, switch: ProbabilitySwitch) -> int | None:
    """The branch with the longest demand in the worst case, or with the shortest one in the best; else None."""
    mode, process = body.resources.options.mode, body.process
    if mode not in (SimulationMode.WORST, SimulationMode.BEST) or process is None:
        return None
    weights = [branch.weight for branch in switch.branches]
    possible = [index for index, weight in enumerate(weights) if weight or not any(weights)]
    model = body.context.demand_model
    demands = {index: model.of_activities(process, switch.branches[index].activities, body.core) for index in possible}
    if mode is SimulationMode.WORST:
        return max(possible, key=lambda index: demands[index].worst)
    return min(possible, key=lambda index: demands[index].best)


def switch(body: Body, activity: Switch) -> None:
    """The first case whose condition is true, or the default."""
    done = JumpLabel()
    for case in activity.cases:
        if case.condition is None:
            raise UnknownError("a branch of a switch has no condition")
        following = body.tested(case.condition)
        body.activities(case.activities)
        body.code.add(operations.JUMP, done)
        body.mark(following)
    body.activities(activity.default or ())
    body.code.mark(done)


def loop(body: Body, activity: Loop) -> None:
    """Activities as long as a condition is true."""
    if activity.condition is None:
        raise UnknownError("a loop has no condition")
    start = body.code.here()
    done = body.tested(activity.condition)
    body.activities(activity.activities)
    body.code.add(operations.JUMP, start)
    body.mark(done)


def terminate(body: Body, activity: Terminate) -> None:
    """The end of the job, also within groups that cannot be interrupted."""
    for _ in range(body.masks):
        body.code.add(operations.UNMASK)
    body.code.add(operations.JUMP, body.end)
