"""Available values of a description or of a model; their systems are built before a search."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import prod
from typing import TypeAlias

from amalthea_uros.design.changes.apply import check_key
from amalthea_uros.design.changes.change import Change, Sweep, compact
from amalthea_uros.design.changes.origin import ChangeOrigin
from amalthea_uros.design.description.origin import DescriptionOrigin
from amalthea_uros.design.model_attributes.origin import ModelOrigin
from amalthea_uros.design.optimize.designs import RebuiltStructure
from amalthea_uros.design.optimize.space import Candidate, Choice, DecisionKind, combinations_of
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.uros.assemble import Assembly

#: The sources that offered values may be of, besides a system.
Source: TypeAlias = DescriptionOrigin | ModelOrigin
#: Each structure is built before the search begins.
MOST_STRUCTURES = 500

#: Makes the rules and orders of the structure of a system; the assembly is that of its description.
Completed = Callable[[tuple[Change, ...], System, Assembly | None], RebuiltStructure]


def offered_values(origin: ChangeOrigin, offers: Iterable[Sweep]) -> Iterator[Choice]:
    """Available values of what is changed where a system comes from, the present one first."""
    for offer in offers:
        present = origin.differences([Change(offer.object, offer.key, offer.values[0])])[0].before
        options = dict.fromkeys(map(compact, (present, *offer.values)))
        yield Choice(object=offer.object, key=offer.key, kind=DecisionKind.OTHER, options=tuple(options))


def structures(
    choices: Sequence[Choice], build: Callable[[Candidate], RebuiltStructure]
) -> Mapping[Candidate, RebuiltStructure | str]:
    """What is built for each combination of options apart from the present one, or why it is impossible.

    Raises
    ------
    InvalidArgumentError : there are more than can be built before the search begins.
    """
    count = prod(len(choice.options) for choice in choices)
    if count > MOST_STRUCTURES:
        names = ", ".join(choice.target for choice in choices)
        raise InvalidArgumentError(
            f"{names} have {count:,} combinations; at most {MOST_STRUCTURES:,} are possible, leave some out with --keep"
        )

    def built(own: Candidate) -> RebuiltStructure | str:
        try:
            return build(own)
        except InvalidArgumentError as error:
            return str(error)

    return {own: built(own) for own in combinations_of(choices) if own}


def is_stated(offer: Sweep, source: Source, assembly: Assembly | None) -> bool:
    """Whether an available value is one of the description or the model that the system has not, or has in another form.

    Raises
    ------
    InvalidArgumentError : nothing has the name, or no description states the value.
    """
    if isinstance(source, ModelOrigin):
        return bool(source.divided(offer.changes()).attributes)
    for change in offer.changes():
        source.divided([change])
    if not source.meant(f"{offer.object}.{offer.key}".removeprefix(".")):
        return False
    if offer.key == "priority":
        return assembly is not None and assembly.priority_scale.zero is not None
    try:
        check_key(source.present.system, offer.object, offer.key)
    except InvalidArgumentError:
        return True
    return False
