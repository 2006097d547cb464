"""Why a value cannot be changed in a description, and what can be changed instead."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros._internal.similar import did_you_mean, similar
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.kinds import KINDS
from amalthea_uros.design.description.keys import DescriptionKey, is_listed, short_name
from amalthea_uros.design.description.owners import controllers_of
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import listed
from amalthea_uros.perf.system import System
from amalthea_uros.uros.described import Described

#: The keys of wires that decide about their bit rates.
_RATES = ("baud_rate", "bitrate", "data_bitrate", "bandwidth", "speed")
#: What people mean by words of other tools.
_CLOCK = (
    "the execution times in an app.yaml are those at the present clock, so those at another one are unknown; measure them there, or "
    "scale them with --scale"
)


def refusal(
    change: Change, keys: Sequence[DescriptionKey], system: System, reason: InvalidArgumentError
) -> InvalidArgumentError:
    """The error for a change that a description cannot state.

    Parameters
    ----------
    reason : what is known of the object
    """
    if change.key == "frequency" and _is_wire(change.object, system):
        rates = [short_name(key, keys) for key in keys if key.path[-1] in _RATES and "transport" in key.path]
        return InvalidArgumentError(
            f"{change}: {change.object!r} is a wire; change its rate in the description: {listed(rates)}"
        )
    if change.key == "frequency" and change.object in system.cores:
        return InvalidArgumentError(f"{change}: {_CLOCK}")
    own = list(dict.fromkeys(key.names[-1] for key in keys if change.object in key.names[:-1] and is_listed(key)))
    known = f"{change.object!r} has {listed(own)}" if own else str(reason)
    if _is_built(change, system):
        return InvalidArgumentError(
            f"{change.target!r} is not stated in the description: it follows from other values; {known}"
        )
    unstated = f"{change}: the description has no value {change.target!r}"
    if meant := _meant(change, keys, own):
        return InvalidArgumentError(f"{unstated}; did you mean {meant!r}?")
    if own:
        return InvalidArgumentError(f"{unstated}; {known}")
    if change.object in _objects(system):
        return InvalidArgumentError(f"{unstated}; {change.object!r} follows from other values of it")
    names = dict.fromkeys((*(name for key in keys for name in key.names[:-1]), *_objects(system)))
    holders = [short_name(key, keys) for key in keys if key.path[-1] == change.key]
    advice = did_you_mean(change.object, names) or (f"{change.key!r} is a key of {listed(holders)}" if holders else "")
    if change.object and not advice:
        return reason
    advice = advice or (str(reason) if change.object else "no object has this key; name a value as in OBJECT.KEY=VALUE")
    return InvalidArgumentError(f"unknown object {change.object!r}; {advice}" if change.object else f"{unstated}; {advice}")


def described_elsewhere(change: Change, described: Described) -> str:
    """Which file describes an object of a robot, if it is not that of the robot; "" otherwise."""
    for _, section, own in controllers_of(change.object, described.description):
        if section.file is not None and own in _objects(described.controllers[section.name].assembly.system):
            return f"{change}: {change.object!r} is described in {section.file}; change {own!r} there"
    return ""


def _meant(change: Change, keys: Sequence[DescriptionKey], own: Sequence[str]) -> str:
    """The value that is meant: the only one with the key, one of the object, or one with a similar name; "" if there is none."""
    elsewhere = [short_name(key, keys) for key in keys if key.path[-1] == change.key]
    if len(elsewhere) == 1:
        return elsewhere[0]
    if near := similar(change.key, own):
        return f"{change.object}.{near[0]}"
    names = (name for key in keys if not key.is_part for name in _names(key))
    return next(iter(similar(change.target, dict.fromkeys(names), cutoff=0.85)), "")


def _names(key: DescriptionKey) -> list[str]:
    """Names that people may have meant."""
    return [".".join((name, key.names[-1])) for name in key.names[:-1]][-3:] or [key.names[-1]]


def _is_wire(name: str, system: System) -> bool:
    wires = system.network.wires
    clocks = {system.cores[core].clock for wire in wires for core in wire.cores if core in system.cores}
    return name in clocks or any(name == wire.name or name in wire.cores for wire in wires)


def _objects(system: System) -> list[str]:
    return [name for kind in KINDS for name in kind.objects(system)]


def _is_built(change: Change, system: System) -> bool:
    return any(change.object in kind.objects(system) and change.key in kind.keys for kind in KINDS)
