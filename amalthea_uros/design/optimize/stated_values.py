"""Available values of what is changed where a system comes from, in a description or in a model; their systems are built before a search."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import prod

from amalthea_uros.design.changes.change import Change, Sweep, compact
from amalthea_uros.design.changes.origin import ChangeOrigin
from amalthea_uros.design.model_attributes.origin import ModelOrigin
from amalthea_uros.design.optimize.designs import RebuiltStructure
from amalthea_uros.design.optimize.space import Candidate, Choice, DecisionKind, combinations_of
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.system import System
from amalthea_uros.uros.assemble import Assembly

#: Each structure is built before the search begins.
MOST_STRUCTURES = 500

#: What makes the rules and orders of the structure of a system; the assembly is that of its description.
Completed = Callable[[tuple[Change, ...], System, Assembly | None], RebuiltStructure]


def offered_values(origin: ChangeOrigin, offers: Iterable[Sweep]) -> Iterator[Choice]:
    """Available values of what is changed where a system comes from, the present one first."""
    for offer in offers:
        present = origin.differences([Change(offer.object, offer.key, offer.values[0])])[0].before
        options = dict.fromkeys(map(compact, (present, *offer.values)))
        yield Choice(object=offer.object, key=offer.key, kind=DecisionKind.OTHER, options=tuple(options))


def check_count(choices: Sequence[Choice]) -> None:
    """Refuse more combinations than can be built before the search begins; raises InvalidArgumentError."""
    count = prod(len(choice.options) for choice in choices)
    if count > MOST_STRUCTURES:
        names = ", ".join(choice.target for choice in choices)
        raise InvalidArgumentError(
            f"{names} have {count:,} combinations; at most {MOST_STRUCTURES:,} are possible, leave some out with --keep"
        )


def attribute_structures(
    origin: ModelOrigin, choices: Sequence[Choice], complete: Completed
) -> Mapping[Candidate, RebuiltStructure | str]:
    """The system of each combination of attributes of a model, apart from the present one; raises as `check_count`."""

    def built(own: Candidate) -> RebuiltStructure | str:
        try:
            return complete(own, origin.configure(own).system, None)
        except InvalidArgumentError as error:
            return str(error)

    check_count(choices)
    return {own: built(own) for own in combinations_of(choices) if own}
