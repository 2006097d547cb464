"""Why a value of a model cannot be changed, and what may be meant."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros._internal.similar import did_you_mean, similar
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.kinds import KINDS
from amalthea_uros.design.model_attributes.keys import ModelKey
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import listed
from amalthea_uros.perf.system import System


def refusal(change: Change, keys: Sequence[ModelKey], system: System, reason: InvalidArgumentError) -> InvalidArgumentError:
    """The error for a change of what neither the system nor the model has.

    Parameters
    ----------
    reason : what is known of the object in the system
    """
    if not change.object:
        return reason
    of_system = [key for kind in KINDS if change.object in kind.objects(system) for key in kind.keys]
    of_model = [key.names[-1] for key in keys if change.object in key.names[:-1]]
    own = list(dict.fromkeys((*of_system, *of_model)))
    if own:
        near = similar(change.key, own)
        if near and near[0] in of_system:
            return reason
        advice = f"did you mean '{change.object}.{near[0]}'?" if near else f"it has {listed(own)}"
        return InvalidArgumentError(f"{change.object!r} has no {change.key!r}; {advice}")
    objects = dict.fromkeys(
        (
            *(name for kind in KINDS for name in kind.objects(system)),
            *(name for key in keys for name in key.names[:-1] if name not in key.path and not name.isdigit()),
        )
    )
    advice = did_you_mean(change.object, objects)
    return InvalidArgumentError(f"unknown object {change.object!r}; {advice}") if advice else reason
