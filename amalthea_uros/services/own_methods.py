"""Analysis methods of users: their bounds beside those of the analysis, which alone decide verdicts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import StrEnum
from typing import TYPE_CHECKING, TypeAlias

from amalthea_uros._internal.entry_points import installed, instances_in, package_of
from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.errors import AmurosError, InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.services.analyze import analyze
from amalthea_uros.services.subject import Subject
from amalthea_uros.timing.basics.stated_times import TimeLike, stated_time
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "amuros.methods"
#: The list of a module that names its methods.
_LIST = "METHODS"

#: Upper bounds by names: a process for its response time, a chain for its reaction time, or "chain.max_data_age"; None: no bound.
Bounds: TypeAlias = Mapping[str, TimeLike | None]


@dataclass(frozen=True, slots=True)
class AnalysisMethod:
    """A method that bounds response times and latencies from above.

    Attributes
    ----------
    source : the paper or the page that proves it
    bounds : what it calculates of an analysis, whose `processes` have the parameters and whose `solution` has the system
    """

    name: str
    source: str
    bounds: Callable[[Analysis], Bounds]


class Standing(StrEnum):
    """How a bound compares with the tightest value of the analysis."""

    TIGHTER = "tighter than the bound of the analysis"
    EQUAL = "equal"
    LOOSER = "looser"
    REFUTED = "refuted: below the exact value"
    ALONE = "the analysis has no bound"
    NOTHING = "no bound"


@dataclass(frozen=True, slots=True)
class MethodRow:
    """A bound of a method.

    Attributes
    ----------
    quantity : "response time", or of a chain
    value : None: the method has no bound
    analyzed, claim : the tightest value of the analysis; None: unknown
    """

    method: str
    object: str
    quantity: str
    value: Time | None
    analyzed: Time | None
    claim: Claim | None

    @property
    def standing(self) -> Standing:
        """How the bound compares with the analysis."""
        if self.value is None:
            return Standing.NOTHING
        if self.analyzed is None:
            return Standing.ALONE
        if self.value == self.analyzed:
            return Standing.EQUAL
        if self.value > self.analyzed:
            return Standing.LOOSER
        return Standing.REFUTED if self.claim is Claim.EXACT else Standing.TIGHTER


@dataclass(frozen=True, slots=True, repr=False)
class MethodBounds(Shown):
    """The bounds of own methods beside those of the analysis."""

    analysis: Analysis
    rows: tuple[MethodRow, ...]

    def __repr__(self) -> str:
        return f"<MethodBounds: {len(self.rows)} values of {len({row.method for row in self.rows})} methods>"


def method_bounds(subject: Subject | Analysis, methods: Iterable[AnalysisMethod] | None = None) -> MethodBounds:
    """Compare methods of users with the analysis; no verdict follows from their values.

    >>> liu_layland = AnalysisMethod("all others once", "an example", lambda analysis: {
    ...     each.name: f"{sum(other.wcet for other in analysis.processes)} ps" for each in analysis.processes})
    >>> print(method_bounds("app.yaml", [liu_layland]))  # doctest: +SKIP

    Parameters
    ----------
    methods : by default those of installed packages, by entry points of the group `amuros.methods`

    Raises
    ------
    InvalidArgumentError : a method fails, or bounds something that does not exist.
    """
    analysis = subject if isinstance(subject, Analysis) else analyze(subject)
    chosen = installed_methods() if methods is None else tuple(methods)
    if not all(isinstance(method, AnalysisMethod) for method in chosen):
        raise TypeError(f"methods must be a list of AnalysisMethod, not {methods!r}")
    return MethodBounds(analysis, tuple(row for method in chosen for row in _rows(method, analysis)))


def installed_methods() -> tuple[AnalysisMethod, ...]:
    """The methods of installed packages.

    Raises
    ------
    InvalidArgumentError : those of a package cannot be loaded.
    """
    return tuple(method for entry in installed(GROUP) for method in _of_package(entry))


def _of_package(entry: EntryPoint) -> list[AnalysisMethod]:
    try:
        return list(instances_in(entry.load(), AnalysisMethod, _LIST))
    except Exception as error:
        message = f"the methods of the package {package_of(entry)!r} cannot be loaded: {type(error).__name__}: {error}"
        raise InvalidArgumentError(message) from None


def _rows(method: AnalysisMethod, analysis: Analysis) -> Iterator[MethodRow]:
    try:
        bounds = dict(method.bounds(analysis))
    except AmurosError:
        raise
    except Exception as error:
        raise InvalidArgumentError(f"the method {method.name!r} failed: {type(error).__name__}: {error}") from error
    for target, bound in bounds.items():
        value = None if bound is None else stated_time(f"{method.name}: {target}", bound, least=0)
        yield _row(method.name, target, value, analysis)


def _row(method: str, target: str, value: Time | None, analysis: Analysis) -> MethodRow:
    if target in analysis.processes.names:
        response = analysis.processes[target].response
        worst, claim = (None, None) if response is None else (response.worst, response.claim)
        return MethodRow(method, target, "response time", value, worst, claim)
    is_chain = target in analysis.chains.names
    chain, _, quantity = (target, "", str(LatencyQuantity.MAX_REACTION_TIME)) if is_chain else target.rpartition(".")
    require("process or chain", [chain], [*analysis.processes.names, *analysis.chains.names])
    require("latency", [quantity], [str(each) for each in LatencyQuantity if each.is_upper])
    latency = analysis.chains[chain].value(LatencyQuantity(quantity))
    bound, claim = (None, None) if latency is None else (latency.value, latency.claim)
    return MethodRow(method, chain, quantity, value, bound, claim)
