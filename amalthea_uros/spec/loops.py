"""The loop of the thread of an executor: one call that spins, or a list of items in their order."""

from __future__ import annotations

from typing import Annotated, Self

from amalthea_uros.spec.fields import Limits, examines
from amalthea_uros.spec.section import DescriptionSection, Shorthand
from amalthea_uros.spec.values import Count, Duration, Name, Offset, problem

_SPINS = ("spin_some", "spin_period", "spin", "items")
#: Keys of an item that say more of what it is.
_BESIDE = ("executor", "attempts", "every")


class LoopItem(DescriptionSection):
    """An item of a loop: exactly one of `spin_some`, `sleep`, `busy_wait`, `publish`, `ping` and `sync`."""

    spin_some: Offset | None = None
    """Timeout of a call of `rclc_executor_spin_some`, of this executor or of the one that `executor` names."""
    executor: Name | None = None
    """The executor that spins, if it is another one; that one has no `loop` of its own."""
    sleep: Offset | None = None
    """Time that the thread sleeps; others execute meanwhile."""
    busy_wait: Offset | None = None
    """Time that the thread waits without sleeping, as in `HAL_Delay`: nothing of lower priority executes meanwhile."""
    publish: Annotated[list[Name], Limits(min_length=1)] | None = None
    """Topics on which it publishes outside of callbacks, each at most once in an iteration."""
    ping: Offset | None = None
    """Longest time of `rmw_uros_ping_agent`: its timeout times its attempts."""
    attempts: Count | None = None
    """Attempts of `rmw_uros_ping_agent` in that time; default: 1."""
    sync: Offset | None = None
    """Timeout of `rmw_uros_sync_session`."""
    every: Duration | None = None
    """Least time between two times that it publishes, pings or synchronises; default: in every iteration."""

    @examines
    def _is_one_item(self) -> Self:
        keys = [key for key in type(self).model_fields if key not in _BESIDE]
        stated = [key for key in keys if getattr(self, key) is not None]
        if len(stated) != 1:
            raise problem(f"expected one of {', '.join(map(repr, keys))}, found {' and '.join(map(repr, stated)) or 'none'}")
        if self.executor is not None and self.spin_some is None:
            raise problem("'executor' has no effect without 'spin_some'")
        if self.publish is not None and len(set(self.publish)) < len(self.publish):
            raise problem("a topic occurs twice in 'publish': use an item for each message")
        if self.attempts is not None and self.ping is None:
            raise problem("'attempts' has no effect without 'ping'")
        if self.every is not None and not self.uses_agent:
            raise problem("'every' has no effect without 'publish', 'ping' or 'sync'")
        return self

    @property
    def is_own_spin(self) -> bool:
        """Whether the executor spins that the loop belongs to."""
        return self.spin_some is not None and self.executor is None

    @property
    def uses_agent(self) -> bool:
        """Whether it sends or waits for an answer, besides a spin."""
        return self.publish is not None or self.ping is not None or self.sync is not None


class LoopSection(Shorthand):
    """How the thread of an executor spins: a list of items, or exactly one of `spin_some`, `spin_period` and `spin`."""

    shorthand = ("items",)
    plain_value = "The items of the loop, in this order."

    spin_some: Offset | None = None
    """Timeout of `rclc_executor_spin_some` in an endless loop; `sleep` follows each call."""
    sleep: Offset = 0
    """Time that the thread sleeps after each `spin_some`; default: none, a bare loop."""
    spin_period: Duration | None = None
    """Period of `rclc_executor_spin_period`, which waits for `timeout`, not for the period."""
    spin: Duration | None = None
    """Timeout of `rclc_executor_spin`, an endless `spin_some`; that of rclc is `1 s`."""
    timeout: Duration | None = None
    """Timeout of the executor, with `spin_period`; default: that of the middleware, 1 s for rclc."""
    items: Annotated[list[LoopItem], Limits(min_length=1, max_length=100)] | None = None
    """What the thread does again and again, in this order: `rclc_executor_spin_some` of this executor once, and more."""

    @examines
    def _is_one_of_four(self) -> Self:
        stated = [key for key in _SPINS if getattr(self, key) is not None]
        if len(stated) != 1:
            raise problem(
                "expected a list, or one of 'spin_some', 'spin_period' and 'spin', "
                f"found {' and '.join(map(repr, stated)) or 'none'}"
            )
        for key, needed in (("sleep", "spin_some"), ("timeout", "spin_period")):
            if key in self.model_fields_set and needed not in stated:
                raise problem(f"{key!r} has no effect without {needed!r}")
        self._check_spins(self.items)
        return self

    @property
    def only_sends(self) -> bool:
        """Whether nothing spins in it: its thread publishes, and that of another executor spins."""
        return self.items is not None and all(item.spin_some is None for item in self.items)

    def _check_spins(self, items: list[LoopItem] | None) -> None:
        if items is None:
            return
        own = sum(item.is_own_spin for item in items)
        if self.only_sends and any(item.uses_agent for item in items):
            return
        if own != 1:
            raise problem(f"expected one 'spin_some' without 'executor', that of this executor, found {own}")
        others = [item.executor for item in items if item.executor is not None]
        twice = next((name for name in others if others.count(name) > 1), None)
        if twice is not None:
            raise problem(f"{twice!r} spins twice in this loop, which is not supported")
