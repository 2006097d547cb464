"""The build options to generate for an application, and an existing file compared with them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from amalthea_uros._internal.ports import known_ports
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros._internal.similar import Suggestions
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import PoolSizes
from amalthea_uros.uros.colcon_meta import ColconMeta, Definition
from amalthea_uros.uros.memory import MemoryDemand
from amalthea_uros.uros.middleware.options import COUNTED, Option, OptionRole, OptionRow
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.storage import storage_of

#: So many are reported of a file; more of them say nothing new.
MAX_FINDINGS = 100

#: Options that no figure depends on.
_OTHERS = ("RMW_UXRCE_DEFAULT_", "RMW_UXRCE_IPV", "UCLIENT_PROFILE_", "UCLIENT_MAX_INPUT_", "UCLIENT_MAX_OUTPUT_")
_MULTITHREAD = "UCLIENT_PROFILE_MULTITHREAD"


@dataclass(frozen=True, slots=True, kw_only=True)
class WaitingMessages(Brief):
    """How many received messages can wait at the same time in a system, which a description alone does not tell.

    Attributes
    ----------
    why : what the number is based on, after a colon
    """

    most: int
    why: str


def with_waiting_messages(options: Sequence[Option], waiting: WaitingMessages | None) -> tuple[Option, ...]:
    """The options, whose storage for messages is for at least so many."""
    return tuple(
        replace(option, needed=waiting.most, counts=f"{option.counts}: {waiting.why}")
        if waiting is not None
        and option.role is OptionRole.QUEUE
        and option.needed is not None
        and option.needed < waiting.most
        else option
        for option in options
    )


def value_of(option: Option) -> int | None:
    """The value to generate for an option; None for its default.

    Pools become as small as possible, as they cost memory; other options keep what the description states, and are set besides only
    where their default is too small.
    """
    if option.without_effect:
        return None
    if option.role in COUNTED:
        return option.smallest
    if option.is_stated:
        value = option.available if option.words else max(option.available, option.smallest or 0)
        return 1 << (value - 1).bit_length() if option.is_power_of_two else value
    return option.smallest if option.is_exceeded else None


def values_of(options: Sequence[Option]) -> list[tuple[Option, int]]:
    """The options to set, with their values."""
    return [(option, value) for option in options if (value := value_of(option)) is not None]


def with_generated_options(profile: Profile, options: Sequence[Option]) -> Profile:
    """The middleware as it is built with the options to generate."""
    return profile.with_options({option.name: value for option, value in values_of(options)})


def check_meta(
    application: Application, profile: Profile, meta: ColconMeta, memory: MemoryDemand, waiting: WaitingMessages | None = None
) -> tuple[Finding, ...]:
    """What is wrong with a file of build options for an application.

    Parameters
    ----------
    memory : with the options of the profile
    waiting : what the storage for messages has to be for; None for what follows from the description alone
    """
    comparison = _MetaComparison(application, profile, memory, waiting)
    return tuple(islice(comparison.findings_of(meta), MAX_FINDINGS))


@dataclass(slots=True)
class _MetaComparison(Brief):
    """Compares a file with what an application needs.

    Attributes
    ----------
    values : of the options in the file that the build accepts
    places : of the options in the file
    """

    application: Application
    profile: Profile
    memory: MemoryDemand
    waiting: WaitingMessages | None
    values: dict[str, int] = field(default_factory=dict)
    places: dict[str, Location] = field(default_factory=dict)
    suggestions: Suggestions = field(default_factory=Suggestions)

    def findings_of(self, meta: ColconMeta) -> Iterator[Finding]:
        """All findings: first about single lines, then about values."""
        for place in meta.comments:
            message = "colcon reads this file as YAML, where '//' and '/*' start no comment: the value after it is lost"
            yield Finding("GEN007", Severity.WARNING, message, place, "Start comments with '#', or remove them.")
        for definition in meta.definitions:
            yield from self._accept(definition)
        described = {option.name: option for option in self.profile.options(self.application)}
        built = self._built()
        for option in with_waiting_messages(built.options(self.application), self.waiting):
            if option.name in self._configured:
                continue
            yield from self._judge(option, described.get(option.name), built, Location(meta.path))

    @property
    def _configured(self) -> Mapping[str, str]:
        """The options that the configuration of the port replaces, with their names there."""
        port = known_ports().get(self.profile.middleware.port or "")
        return port.kconfig if port is not None else {}

    def _accept(self, definition: Definition) -> Iterator[Finding]:
        """Keep the value of an option, or say why the build does not."""
        name, place = definition.name, definition.location
        row = self.profile.option_table.get(name)
        if row is None:
            if (advice := self._misspelled(name)) is not None:
                message = f"unknown option {name}: it has no effect"
                yield Finding("GEN003", Severity.WARNING, message, place, advice)
            return
        if definition.package != row.package:
            message = f"{name} has no effect in {definition.package!r}: it is an option of {row.package!r}"
            yield Finding("GEN005", Severity.WARNING, message, place, f"Set it for {row.package!r}.")
            return
        if name in self.places:
            message = f"{name} has no effect: it is set again on line {place.line}"
            yield Finding("GEN005", Severity.WARNING, message, self.places[name], "Remove one of them.")
        self.places[name] = place
        if (setting := self._configured.get(name)) is not None:
            message = f"{name} has no effect: {setting} of the configuration of the port replaces it"
            yield Finding("GEN005", Severity.WARNING, message, place, f"Set {setting} in prj.conf.")
            return
        value = row.number(definition.value)
        problem = _problem(row, value, definition.value)
        if problem is None and value is not None:
            self.values[name] = value
            return
        self.values.pop(name, None)
        yield Finding("GEN004", Severity.ERROR, f"{name} is {definition.value[:40]!r}: {problem}", place, "Correct the value.")

    def _misspelled(self, name: str) -> str | None:
        """Advice about a name that no option has; None if it may be one that is not known here."""
        family = name.partition("_")[0]
        if name.startswith(_OTHERS) or family not in {known.partition("_")[0] for known in self.profile.option_table}:
            return None
        near = self.suggestions.nearest(name, self.profile.option_table)
        return f"Did you mean {near}?" if near else "Remove it." if name.startswith("RMW_UXRCE_") else None

    def _built(self) -> Profile:
        """The middleware that is built with the file."""
        middleware = self.profile.middleware
        update = {
            "limits": PoolSizes.model_construct(),
            "multithread": self.values.get(_MULTITHREAD, 0) == 1,
            "reliable": middleware.reliable.model_copy(update={"timeout": None}),
        }
        return self.profile.configured(middleware.model_copy(update=update)).with_options(self.values)

    def _judge(self, option: Option, described: Option | None, built: Profile, file: Location) -> Iterator[Finding]:
        """What is wrong with the value that an option has with the file."""
        place = self.places.get(option.name, file)
        if option.name in self.places and option.name not in self.values:
            return
        if option.without_effect:
            if option.name in self.places:
                message = f"{option.name} has no effect: {option.without_effect}"
                yield Finding("GEN005", Severity.WARNING, message, place, "Remove it.")
        elif option.is_exceeded:
            severity = Severity.WARNING if option.role is OptionRole.QUEUE else Severity.ERROR
            value = f"{option.text(option.available)}" + ("" if option.name in self.places else " by default")
            message = f"{option.name} is {value}, but the application needs {option.smallest}: {option.counts}"
            advice = self._advice(option, built)
            yield Finding("GEN001", severity, message, place, f"{option.when_exhausted} {advice}".strip())
        elif option.role in COUNTED and option.name in self.values and self.values[option.name] >= 0:
            yield from self._surplus(option, built, place)
        elif described is not None and not described.without_effect and option.role is OptionRole.SETTING:
            yield from self._difference(option, described, place)

    def _advice(self, option: Option, built: Profile) -> str:
        """A value for an option, as far as the memory of the board has room for it."""
        if option.role is OptionRole.QUEUE and option.smallest is not None:
            static = self.profile.memory(self.application), built.memory(self.application)
            options = built.options(self.application)
            storage = storage_of(built, self.application, options, self.memory.with_static(*static))
            if storage is not None:
                return storage.advice(option.smallest, str(option.smallest))
        return f"Set it to {option.smallest}."

    def _surplus(self, option: Option, built: Profile, place: Location) -> Iterator[Finding]:
        smallest = option.smallest
        if smallest is None or option.available <= smallest:
            return
        saved = self._size(built) - self._size(built.with_options({option.name: smallest}))
        message = f"{option.name} is {option.available}, but {smallest} would be enough"
        advice = f"Set it to {smallest} to save {saved} B." if saved else f"Set it to {smallest}."
        yield Finding("GEN002", Severity.INFO, message, place, advice)

    def _difference(self, option: Option, described: Option, place: Location) -> Iterator[Finding]:
        expected = value_of(described)
        value = described.available if expected is None else expected
        # Choices between words that the description leaves open change no figure.
        matters = described.is_stated or (option.name in self.places and not option.words)
        if matters and option.available != value:
            unit = f" {option.unit}" if option.unit else ""
            default = "" if option.name in self.places else " by default"
            message = (
                f"{option.name} is {option.text(option.available)}{unit}{default}, but {option.text(value)}{unit} in app.yaml"
            )
            advice = "The figures for the other value do not hold. Change one of them."
            yield Finding("GEN008", Severity.WARNING, message, place, advice)

    def _size(self, built: Profile) -> int:
        return sum(use.size for use in built.memory(self.application))


def _problem(row: OptionRow, value: int | None, text: str) -> str | None:
    """Why the build does not take a value; None if it does."""
    if value is None:
        return f"expected {' or '.join(row.words)}" if row.words else "expected a whole number"
    if row.words:
        return None
    is_automatic = row.default is not None and value == row.default
    if value < row.least and not is_automatic:
        return f"expected {row.least} or more"
    if value > 2**31 - 1:
        return "it is too large"
    return "expected a power of two" if row.is_power_of_two and value & (value - 1) else None
