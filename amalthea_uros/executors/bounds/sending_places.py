"""Where in its jobs the task of an executor sends a message.

That a message is sent once in each call of a callback, always after and before the same parts of it, is not certain in a model: another
callback or process can call that callback, too, and triggers can be repeated, or be in branches and in groups without an order.
"""

from __future__ import annotations

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Call, Trigger
from amalthea_uros.perf.executors import Handle, Publication
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.jobs.positions import ActivityPosition, is_in_fixed_order


@dataclass(frozen=True, slots=True)
class SendingPlaces:
    """The places at which a call of a callback sends a message.

    Attributes
    ----------
    most : messages of a call
    is_same : whether it is the same place in each call, with the same parts of the callback before and after it
    """

    most: int
    is_same: bool


def sending_places(handle: Handle, publication: Publication, task: str, context: TimingContext) -> SendingPlaces | None:
    """The places of a publication; None if not only the calls of its handle send it, or an unknown number of times.

    Parameters
    ----------
    task : of the executor of the handle
    """
    try:
        found = {name: context.dataflow.events.positions(name) for name in context.system.processes}
    except UnknownError:
        return None
    calls = [each for of_process in found.values() for each in of_process if _calls(each, handle.runnable)]
    if [each.times for each in calls if each.process.name == task] != [1] or len(calls) > 1:
        return None
    stimuli = context.system.processes[publication.transmission or ""].stimuli
    sending = [each for each in found[task] if isinstance(each.activity, Trigger) and each.activity.stimulus in stimuli]
    times = [each.times for each in sending if each.times is not None]
    if len(times) < len(sending) or any(not calls[0].number <= each.number <= calls[0].last for each in sending):
        return None
    # One for which the model has no trigger is sent at the end of the callback.
    declared = sum(each.transmission == publication.transmission for each in handle.publications)
    most = max(declared, sum(times))
    return SendingPlaces(most, most == 1 and all(map(is_in_fixed_order, sending)))


def _calls(position: ActivityPosition, runnable: str) -> bool:
    return isinstance(position.activity, Call) and position.activity.runnable == runnable
