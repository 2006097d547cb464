"""How data pass between processes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations_with_replacement, product
from typing import NamedTuple

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import AccessKind, Communication, LabelAccess, Protection, SenderReceiverAccess
from amalthea_uros.perf.named import Located
from amalthea_uros.perf.software import Label
from amalthea_uros.timing.blocking.critical_sections import exclusively_held
from amalthea_uros.timing.dataflow.chains import steps
from amalthea_uros.timing.dataflow.routes import crosses, is_linked
from amalthea_uros.timing.dataflow.untyped_events import readings
from amalthea_uros.timing.jobs.positions import ActivityPosition
from amalthea_uros.timing.scheduling.allocation import operating_system_of
from amalthea_uros.validate.rule import SystemProblem, system_rule
from amalthea_uros.validate.system_context import SystemContext
from amalthea_uros.validate.wording import joined


class _UnlinkedStep(NamedTuple):
    """A step of a chain.

    Attributes
    ----------
    item : the chain or segment
    first, then : events
    """

    chain: str
    item: Located
    first: str
    then: str


def _unlinked_steps(context: SystemContext) -> Iterator[_UnlinkedStep]:
    """All of them; events of which it is unknown where they occur do not count.

    What a message passes between events on wires and in executors that loop, the analysis of its way says.
    """
    system, events = context.system, context.system.events_by_name
    for chain in system.events.chains:
        if crosses(chain, context.dataflow):
            continue
        for item, starts, ends in steps(chain, system):
            for first, then in product(starts, ends):
                is_known = first != then and first in events and then in events
                if not is_known:
                    continue
                moments = readings((events[first], events[then]))
                if not any(is_linked(start, end, context.dataflow) for start, end in moments):
                    yield _UnlinkedStep(chain.name, item, first, then)


@system_rule("TIM-CHAIN-CARRIED")
def _check_chain_carried(context: SystemContext) -> Iterator[SystemProblem]:
    for step in _unlinked_steps(context):
        message = f"no data flow or trigger connects {step.first!r} to {step.then!r}"
        yield SystemProblem(step.item, message, step.chain)


class _Writing(NamedTuple):
    """A write access, and the semaphores held there."""

    position: ActivityPosition
    held: frozenset[str]


#: Where processes may run, and what they hold.
_Kind = tuple[frozenset[str], frozenset[str]]


@system_rule("TIM-UNPROTECTED")
def _check_unprotected(context: SystemContext) -> Iterator[SystemProblem]:
    protected = {label for group in context.system.constraints.data_groups for label in group.labels}
    stated = _by_operating_system(context)
    for name, writings in _writings(context).items():
        label = context.system.labels.get(name)
        if label is None or name in protected:
            continue
        exposed = [w for w in writings if not _is_protected(w.position, label, stated.get(w.position.process.name))]
        if _may_collide(exposed, context):
            processes = dict.fromkeys(writing.position.process.name for writing in exposed)
            names = joined(f"{process!r} on {'/'.join(sorted(context.cores[process]))}" for process in processes)
            yield SystemProblem(label, f"{name!r} is written by {names} without a common semaphore or a stated protection")


def _writings(context: SystemContext) -> dict[str, list[_Writing]]:
    """The writes to each label in the jobs of processes that are allocated to a core."""
    found: dict[str, list[_Writing]] = {}
    for process in context.system.processes:
        if process not in context.cores:
            continue
        try:
            positions = context.dataflow.events.positions(process)
        except UnknownError:
            continue
        for position, held in zip(positions, exclusively_held(positions, context.system), strict=True):
            access = position.activity
            if isinstance(access, LabelAccess | SenderReceiverAccess) and access.kind is AccessKind.WRITE:
                found.setdefault(access.label, []).append(_Writing(position, held))
    return found


def _may_collide(writings: Sequence[_Writing], context: SystemContext) -> bool:
    """Whether two processes may write on different cores without a common semaphore."""
    # Processes on the same cores with the same semaphores are considered together.
    kinds: dict[_Kind, set[str]] = {}
    for writing in writings:
        process = writing.position.process.name
        kinds.setdefault((context.cores[process], writing.held), set()).add(process)
    return any(
        len(one[0] | other[0]) > 1 and not one[1] & other[1] and len(kinds[one] | kinds[other]) > 1
        for one, other in combinations_with_replacement(kinds, 2)
    )


#: Protection that model elements do not have to show.
_PROTECTED = (Protection.AUTOMATIC, Protection.CUSTOM)


def _is_protected(position: ActivityPosition, label: Label, by_system: Protection | None) -> bool:
    """Whether a protection is stated; copies at the start and end of a job, or at fixed times, are one, too."""
    access = position.activity
    by_access, is_copied = None, False
    if isinstance(access, LabelAccess):
        by_access, is_copied = access.protection, access.communication in (Communication.IMPLICIT, Communication.LET)
    # The access decides, then the label, then the operating system.
    levels: Iterable[Protection | None] = (by_access, label.protection, by_system)
    stated = next((level for level in levels if level not in (None, Protection.INHERITED)), None)
    return is_copied or stated in _PROTECTED


def _by_operating_system(context: SystemContext) -> dict[str, Protection | None]:
    """What the operating system of each process states."""
    system = context.system
    of_scheduler = operating_system_of(system)
    stated = {each.name: each.protection for each in system.os.systems}
    allocations = [(task.task, task.scheduler) for task in system.mapping.tasks]
    allocations += [(isr.isr, isr.controller) for isr in system.mapping.isrs]
    return {process: stated.get(of_scheduler.get(scheduler, "")) for process, scheduler in allocations}
