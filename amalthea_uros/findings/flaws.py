"""Which findings report the same flaw, and which ones follow from another finding."""

from __future__ import annotations

import re
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding


class FindingSource(NamedTuple):
    """The findings of an id, or those of them whose message contains one of some words.

    Attributes
    ----------
    id : of a rule, or of another kind of finding
    about : names of features; without any, all findings of the id are meant
    """

    id: str
    about: tuple[str, ...] = ()

    def has(self, finding: Finding) -> bool:
        """Whether a finding is meant."""
        if finding.rule != self.id:
            return False
        return not self.about or not set(self.about).isdisjoint(re.findall(r"\w+", finding.message))


@dataclass(frozen=True, slots=True)
class Flaw:
    """Findings at one object that report the same flaw.

    Attributes
    ----------
    sources : the one whose message says most comes first
    same_name : an object can have the flaw several times; only findings that name the same thing belong together
    in_file : they may be reported at different places of a file
    of_events : some of them name functions, others the events of these
    """

    sources: tuple[FindingSource, ...]
    same_name: bool = False
    in_file: bool = False
    of_events: bool = False


@dataclass(frozen=True, slots=True)
class Consequence:
    """Findings that disappear together with the finding that is their cause.

    Attributes
    ----------
    in_file : they are anywhere in the file of the cause, not only at its object
    same_name : only those that name the same thing as the cause
    except_named_by : not those that name the same thing as a finding of this id, which then is their cause
    """

    cause: FindingSource
    effects: tuple[FindingSource, ...]
    in_file: bool = False
    same_name: bool = False
    except_named_by: str = ""


def _required(*features: str) -> FindingSource:
    return FindingSource("AM-EMF-INTRINSIC/required-feature", features)


def _sources(*items: str | FindingSource) -> tuple[FindingSource, ...]:
    return tuple(FindingSource(item) if isinstance(item, str) else item for item in items)


def _flaw(*items: str | FindingSource, same_name: bool = False, in_file: bool = False, of_events: bool = False) -> Flaw:
    return Flaw(_sources(*items), same_name, in_file, of_events)


#: Attributes whose type has a limit: what the schema of the newest version says of them, a rule says for every version.
_LIMITED = (
    *("alpha", "beta", "endAddress", "fillLevel", "initialValue", "maxBurstSize", "maxConcurrentTransfers", "maxValue"),
    *("memOffset", "memoryPositionAddress", "minItemsCompleted", "numberOfOccurrences", "occurrenceCount", "occurrences"),
    *("offset", "pRemainPromille", "prescaler", "samplingOffset", "samplingRecurrence", "sd", "startAddress", "step", "value"),
)

FLAWS = (
    # Files and references
    _flaw("XMI007", "XSD000", "INC-IO-VERSION", in_file=True),
    _flaw("XSD001", "XMI010", "XMI011", "XMI012", "XMI013", "XMI014", "XMI015", "INC-IO-FEATURE", same_name=True),
    *(_flaw(FindingSource("AM-EMF-INTRINSIC/datatype", (each,)), FindingSource("XSD001", (each,))) for each in _LIMITED),
    _flaw("XMI023", "AM-EMF-INTRINSIC/proxy-resolves", "XMI020", "INC-IO-REF", "EXT003", same_name=True),
    _flaw("AM-EMF-INTRINSIC/unique-id", "AM-EMF-SCOPE", "INC-IO-NAME"),
    _flaw("EMF-ID", "INC-IO-XMIID"),
    _flaw("AM-EMF-INTRINSIC/map-entry-unique", "AM-Basic-CustomProperty-Key", same_name=True),
    _flaw("AM-Basic-Quantity", "INC-ST-UNIT"),
    # Hardware
    _flaw("TIM-CLOCK", "INC-HW-PU-CLOCK"),
    _flaw("AM-HW-Port", "DOC-HwPort-Single-Connection"),
    _flaw("AM-HW-Port-Definition", "INC-HW-CONN-PORTS"),
    _flaw("AM-HW-Structure", "INC-HW-CONN-PORTS"),
    _flaw("AM-HW-Connection", _required("port1", "port2"), "INC-HW-CONN-PORTS"),
    # Stimuli
    _flaw("TIM-STIMULUS", "INC-ST-NONE"),
    _flaw("TIM-PERIOD", "INC-ST-PERIOD", _required("recurrence", "nextOccurrence", "step", "occurrencesPerStep")),
    _flaw(FindingSource("AM-EMF-INTRINSIC/datatype", ("occurrenceCount",)), "INC-ST-BURST"),
    _flaw("AM-Basic-Counter", FindingSource("AM-EMF-INTRINSIC/datatype", ("offset", "prescaler"))),
    # Mapping and scheduling
    _flaw("TIM-PRIORITY-SHARED", "UR106"),
    _flaw("TIM-ALLOCATION", "AM-Mapping-Task-Scheduler", "AM-Mapping-ISR-Scheduler", "INC-MAP-TASK-ONCE"),
    _flaw("AM-Mapping-Scheduler-ProcessingUnit", "INC-MAP-SCHED"),
    _flaw(_required("scheduler"), "INC-MAP-SCHED"),
    _flaw(_required("task", "scheduler"), "INC-MAP-TASK"),
    _flaw(_required("isr", "controller"), "INC-MAP-ISR"),
    _flaw(_required("abstractElement", "memory"), "INC-MAP-MEMORY"),
    _flaw(_required("key"), "INC-OS-PARAM-KEY"),
    # Software
    _flaw("TIM-TICKS", "INC-SW-TICKS-DEFAULT"),
    _flaw("TIM-BOUNDS", "INC-SW-TICKS-GAUSS"),
    _flaw("AM-EMF-INTRINSIC/ModeLabel", "DOC-Enum-Initial", "INC-SW-MODE-VALUE"),
    _flaw("AM-EMF-INTRINSIC/ModeLabel", _required("mode"), "INC-SW-MODE-MISSING"),
    _flaw("AM-EMF-INTRINSIC/ModeLabelAccess", "INC-SW-MODE-VALUE"),
    _flaw("AM-EMF-INTRINSIC/ModeValue", "INC-SW-MODE-VALUE"),
    _flaw("AM-EMF-INTRINSIC/ModeValue", _required("label"), "INC-SW-CONDKIND"),
    _flaw(_required("condition"), "INC-SW-CONDSET"),
    _flaw(_required("semaphore"), "INC-SW-ACCESS"),
    _flaw(_required("serverRunnable"), "INC-SW-SERVER"),
    _flaw(FindingSource("AM-EMF-INTRINSIC/required-feature"), "INC-SW-REF"),
    # Chains and constraints
    _flaw("TIM-CHAIN-CARRIED", "UR130", "CHN002", same_name=True, in_file=True, of_events=True),
    _flaw("AM-Constraints-EventChain", "INC-EC-SEQ"),
    _flaw(_required("stimulus", "response"), "INC-EC-ENDS"),
    _flaw(_required("scope"), "INC-LC-SCOPE"),
    _flaw("DOC-ProcessScope", FindingSource("AM-EMF-INTRINSIC/multiplicity", ("runnableGroups",))),
)

CONSEQUENCES = (
    # What the version of the file does not have, or the reader does not know yet, is found all over the file.
    Consequence(FindingSource("INC-IO-VERSION"), _sources("INC-IO-FEATURE"), in_file=True),
    Consequence(FindingSource("XMI007"), _sources("XMI010", "XMI011", "INC-IO-FEATURE"), in_file=True),
    # Objects of files that were not read cannot be found.
    Consequence(
        FindingSource("XMI025"),
        _sources("AM-EMF-INTRINSIC/proxy-resolves", "INC-IO-REF"),
        in_file=True,
        except_named_by="XMI020",
    ),
    Consequence(FindingSource("AM-EMF-INTRINSIC/unique-id"), _sources("XMI021"), in_file=True, same_name=True),
    Consequence(FindingSource("AM-EMF-SCOPE"), _sources("XMI021"), in_file=True, same_name=True),
    Consequence(FindingSource("EMF-ID"), _sources("XMI022"), in_file=True),
    Consequence(FindingSource("AM-EMF-INTRINSIC/proxy-resolves"), _sources("INC-HW-CONN-PORTS")),
    Consequence(FindingSource("DOC-Feature-Single"), _sources("AM-HW-Definition")),
    Consequence(FindingSource("AM-HW-Module-Definition"), _sources("INC-HW-MEM-SIZE")),
    Consequence(FindingSource("TIM-ALLOCATION"), _sources("DOC-Task-Single-Scheduler"), in_file=True, same_name=True),
    # Tasks of a scheduler without a core are never executed; a stimulus that is not converted never activates a process.
    Consequence(
        FindingSource("AM-Mapping-Scheduler-ProcessingUnit"),
        _sources("DOC-Task-Affinity-Intersection"),
        in_file=True,
        same_name=True,
    ),
    Consequence(FindingSource("INC-ST-TYPE"), _sources("INC-ST-ORDER"), in_file=True, same_name=True),
    Consequence(_required("nextOccurrence"), _sources("INC-ST-RELPER")),
    # A mean cannot be within bounds of which the lower one is above the upper one.
    Consequence(
        FindingSource("AM-EMF-INTRINSIC/TruncatedTimeDistribution"),
        _sources("TA-Basic-TimeGaussDistribution-mean"),
    ),
    Consequence(
        FindingSource("AM-EMF-INTRINSIC/TruncatedDiscreteValueDistribution"),
        _sources("TA-Basic-DiscreteValueGaussDistribution-mean"),
    ),
    Consequence(
        FindingSource("AM-EMF-INTRINSIC/TruncatedContinuousValueDistribution"),
        _sources("TA-Basic-ContinuousValueGaussDistribution-mean"),
    ),
)
