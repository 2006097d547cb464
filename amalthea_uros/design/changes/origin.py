"""Where a system comes from, and what changes of that make of the system."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.changes.apply import Difference, apply
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.timing_changes import described


class ChangeOrigin(Protocol):
    """A system on which changes act; it can be sent to other processes."""

    @property
    def present(self) -> Configuration:
        """The system and the settings without changes."""
        ...

    def configure(self, changes: Sequence[Change]) -> Configuration:
        """The system and the settings with changes; InvalidArgumentError if something is wrong with one."""
        ...

    def differences(self, changes: Sequence[Change]) -> tuple[Difference, ...]:
        """The values before and after changes, and what else differs because of them; raises as `configure`."""
        ...


@dataclass(frozen=True, slots=True)
class SystemOrigin:
    """A system that was read from a model or made by a program."""

    present: Configuration

    def configure(self, changes: Sequence[Change]) -> Configuration:
        """The system and the settings with changes; InvalidArgumentError if something is wrong with one."""
        return apply(*self.present, changes)

    def after(self, changes: Sequence[Change]) -> SystemOrigin:
        """The changed system; raises as `configure`."""
        return SystemOrigin(self.configure(changes))

    def differences(self, changes: Sequence[Change]) -> tuple[Difference, ...]:
        """The values before and after changes, and what else differs because of them; raises as `configure`."""
        return described(self.present, changes) if changes else ()

    def __reduce__(self) -> tuple[object, ...]:
        # A replaced system has no tables of names yet.
        return SystemOrigin, (self.present._replace(system=replace(self.present.system)),)
