"""The storage for received messages: how many slots the memory of the board has room for, and the advice about their number.

All slots have the same size, whatever message they hold, as in src/types.h of micro-ROS/rmw_microxrcedds. What else micro-ROS takes is
in `memory`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros._internal.lazy_mapping import LazyMapping
from amalthea_uros._internal.plural import enumerated
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.application import Application
from amalthea_uros.uros.memory import MemoryDemand
from amalthea_uros.uros.middleware.options import Option, OptionRole
from amalthea_uros.uros.middleware.profile import Profile

_WAITING = "take messages earlier, shorten the timeout of publications, or set a smaller 'depth'"


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageStorage(Brief):
    """The slots for received messages of a middleware, and the memory for them.

    Attributes
    ----------
    option, location : the build option with their number, and where the description states it
    slots, needed : their number in the description, and how many are known to be needed
    slot : bytes of a slot
    limit : bytes of memory, with the name of what has it; None if it is not specified
    room : slots that fit beside all else that is known; None without a limit
    unknown : processes whose stacks are not stated, so that fewer slots can fit
    smaller : the slots that fit with MTUs that are enough for the application, in descending order, found once somebody looks at them
    mtu_option : the build option with the MTU
    looping : the executors that spin in loops
    """

    option: str
    location: Location | None
    slots: int
    needed: int
    slot: int
    limit: tuple[int, str] | None
    room: int | None
    unknown: tuple[str, ...]
    smaller: Mapping[int, int] = field(default_factory=dict)
    mtu_option: str = ""
    looping: frozenset[str] = frozenset()

    def advice(self, least: int, value: str) -> str:
        """How to get the slots that are needed: a value for the build, or if none fits, what else helps.

        Parameters
        ----------
        least : slots that are needed at least
        value : the value in words
        """
        if self.room is None or least <= self.room:
            return f"Set {self.option} to {value} in the build and under 'limits'. {self._room_text()}"
        few = f"No value of {self.option} is enough: at least {least} slots of {self.slot} B are needed, but {self._fits()}."
        if not self.smaller:
            return f"{few} T{_WAITING[1:]}."
        every = tuple(self.smaller.items())
        size, room = next((each for each in every if each[1] >= least), every[-1])
        return f"{few} Set {self.mtu_option} to {size}, with which {_fit(room)}, or {_WAITING}."

    @property
    def reduction(self) -> str:
        """How to make the slots fit; "" if the memory is not specified."""
        return "" if self.room is None else self.advice(max(1, self.needed), f"{self.room} or less")

    def _room_text(self) -> str:
        if self.room is None:
            return f"A slot takes {self.slot} B, and the memory of the board is not stated."
        return f"A slot takes {self.slot} B, and {self._fits()}."

    def _fits(self) -> str:
        assert self.limit is not None
        size, owner = self.limit
        verb = "is" if len(self.unknown) == 1 else "are"
        stacks = "stack" if len(self.unknown) == 1 else "stacks"
        less = f"; the {stacks} of {enumerated(sorted(self.unknown))} {verb} not stated" if self.unknown else ""
        return f"{_fit(self.room or 0)} in the {size} B of {owner}{less}"


def _fit(count: int) -> str:
    return "1 slot fits" if count == 1 else f"{count or 'no'} slots fit"


def storage_of(
    profile: Profile, application: Application, options: Sequence[Option], memory: MemoryDemand
) -> MessageStorage | None:
    """The storage of an application; None if its middleware has no slots.

    Parameters
    ----------
    options : of the profile
    memory : with these options
    """
    option = next((each for each in options if each.role is OptionRole.QUEUE), None)
    if option is None or profile.slot_size is None or profile.slots is None:
        return None
    mtu = next((each for each in options if each.name.endswith("_TRANSPORT_MTU") and each.needed is not None), None)
    return MessageStorage(
        option=option.name,
        location=profile.middleware.limits.location(option.name),
        slots=profile.slots,
        needed=option.needed or 0,
        slot=profile.slot_size,
        limit=memory.limit,
        room=_room(profile, memory),
        unknown=memory.stacks.unknown,
        smaller={} if mtu is None else LazyMapping(lambda: dict(_with_smaller(mtu, profile, application, memory))),
        mtu_option="" if mtu is None else mtu.name,
        looping=frozenset(each.name for each in profile.middleware.stated_executors if each.loop is not None),
    )


def _room(profile: Profile, memory: MemoryDemand) -> int | None:
    if memory.limit is None or profile.slot_size is None or profile.slots is None:
        return None
    rest = memory.counted - profile.slots * profile.slot_size
    return max(0, (memory.limit[0] - rest) // profile.slot_size)


def _with_smaller(mtu: Option, profile: Profile, application: Application, memory: MemoryDemand) -> Iterator[tuple[int, int]]:
    """Half the MTU, half of that, and so on, as long as all messages fit in it and in the buffers of the streams."""
    size = mtu.available // 2
    while size:
        other = profile.with_options({mtu.name: size})
        # Of the settings, the application needs an MTU and buffers of streams.
        if any(each.is_exceeded for each in other.options(application) if each.role is OptionRole.SETTING):
            return
        room = _room(other, memory.with_static(profile.memory(application), other.memory(application)))
        if room is None:
            return
        yield size, room
        size //= 2
