"""Mode labels as numbers: the index of a literal, or the number itself."""

from __future__ import annotations

import re
from collections.abc import Mapping

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.conditions import ChannelFillIs, Comparison, Condition, ModeLabelsAre, ModeValueIs, Relation, Undecided
from amalthea_uros.perf.software import ModeLabel
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.kernel import conditions, layout
from amalthea_uros.simulate.program.image import Image

_RELATIONS = {
    Relation.EQUAL: conditions.EQUAL,
    Relation.NOT_EQUAL: conditions.NOT_EQUAL,
    Relation.LESS: conditions.LESS,
    Relation.LESS_OR_EQUAL: conditions.LESS_OR_EQUAL,
    Relation.GREATER: conditions.GREATER,
    Relation.GREATER_OR_EQUAL: conditions.GREATER_OR_EQUAL,
}
_WHOLE_NUMBER = re.compile(r"[+-]?\d{1,19}", re.ASCII)
#: A literal that no enumeration has.
_NO_LITERAL = -1


@dataclass(slots=True)
class ModeRecords:
    """The mode labels and channels in memory, and the conditions on them.

    Attributes
    ----------
    known : values of mode labels that do not change
    _unset : why the values of mode labels are not known at first
    """

    system: System
    image: Image
    known: Mapping[str, str]
    labels: dict[str, int] = field(default_factory=dict)
    channels: dict[str, int] = field(default_factory=dict)
    _literals: dict[str, tuple[str, ...]] = field(default_factory=dict)
    _unset: dict[str, str] = field(default_factory=dict)
    _conditions: dict[Condition, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        literals = {mode.name: mode.literals for mode in self.system.software.modes}
        for label in self.system.software.mode_labels:
            self._literals[label.name] = literals.get(label.mode or "", ())
            self.labels[label.name] = self._label(label)
        for channel in self.system.software.channels:
            fields = {layout.FILL: channel.default_elements, layout.CAPACITY: channel.capacity}
            self.channels[channel.name] = self.image.record(layout.CHANNEL_SIZE, fields)

    def _label(self, label: ModeLabel) -> int:
        value = self.known.get(label.name, label.initial)
        fields = {layout.LITERALS: len(self._literals[label.name]), layout.IS_CONSTANT: int(label.name in self.known)}
        if value is None:
            self._unset[label.name] = "no initial value"
        else:
            try:
                fields[layout.MODE_VALUE] = self.value(label.name, value)
            except UnknownError:
                self._unset[label.name] = f"the initial value {value!r}, which is no whole number, or too large"
        return self.image.record(layout.MODE_SIZE, fields)

    def label(self, name: str) -> int:
        """The place of a mode label."""
        if name not in self.labels:
            raise UnknownError(f"the mode label {name!r} is not defined in the model")
        return self.labels[name]

    def channel(self, name: str) -> int:
        """The place of a channel."""
        if name not in self.channels:
            raise UnknownError(f"the channel {name!r} is not defined in the model")
        return self.channels[name]

    def value(self, label: str, text: str) -> int:
        """The number of a value of a mode label."""
        literals = self._literals.get(label, ())
        if literals:
            return literals.index(text) if text in literals else _NO_LITERAL
        if _WHOLE_NUMBER.fullmatch(text) is None or abs(int(text)) >= layout.NEVER:
            raise UnknownError(f"the value {text!r} of the mode label {label!r} is no whole number, or too large")
        return int(text)

    def condition(self, condition: Condition) -> int:
        """The place of a condition."""
        if condition not in self._conditions:
            if not all(condition.alternatives):
                raise UnknownError("a condition compares nothing")
            compared = [[self._comparison(each) for each in every] for every in condition.alternatives]
            alternatives = []
            for comparisons in compared:
                first = len(self.image.words)
                for fields in comparisons:
                    self.image.record(layout.COMPARISON_SIZE, fields)
                alternatives.append({layout.COMPARISONS: first, layout.COMPARISONS_END: len(self.image.words)})
            first = len(self.image.words)
            for fields in alternatives:
                self.image.record(layout.ALTERNATIVE_SIZE, fields)
            ends = {layout.ALTERNATIVES: first, layout.ALTERNATIVES_END: len(self.image.words)}
            self._conditions[condition] = self.image.record(layout.CONDITION_SIZE, ends)
        return self._conditions[condition]

    def _comparison(self, comparison: Comparison) -> dict[int, int]:
        match comparison:
            case ModeValueIs(label=label, relation=relation, value=value):
                left = self._compared(label, relation)
                return {
                    layout.LEFT_VALUE: left,
                    layout.RIGHT_CONSTANT: self.value(label, value),
                    layout.RELATION: _RELATIONS[relation],
                }
            case ModeLabelsAre(first=first, relation=relation, second=second):
                if self._literals.get(first) != self._literals.get(second):
                    raise UnknownError(f"the mode labels {first!r} and {second!r} are compared, but have different modes")
                left, right = self._compared(first, relation), self._compared(second, relation)
                return {layout.LEFT_VALUE: left, layout.RIGHT_VALUE: right, layout.RELATION: _RELATIONS[relation]}
            case ChannelFillIs(channel=channel, relation=relation, level=level):
                return {
                    layout.LEFT_VALUE: self.channel(channel) + layout.FILL,
                    layout.RIGHT_CONSTANT: level,
                    layout.RELATION: _RELATIONS[relation],
                }
            case Undecided(reason=reason):
                raise UnknownError(f"a condition cannot be decided: {reason}")

    def _compared(self, label: str, relation: Relation) -> int:
        place = self.label(label)
        if label in self._unset:
            raise UnknownError(f"the mode label {label!r}, on which a condition depends, has {self._unset[label]}")
        if self._literals[label] and relation not in (Relation.EQUAL, Relation.NOT_EQUAL):
            raise UnknownError(f"the literals of the mode label {label!r} have no order, but are compared by {relation}")
        return place + layout.MODE_VALUE
