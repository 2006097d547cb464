"""Counts what of the models of a folder arrives in INCHRON projects: `python benchmarks/project_exports.py FOLDER`.

For each construct: how many there are, how many INCHRON's importer am2inc converts by its rules (none of a file at which it fails), and
how many `amuros export` writes as something that chronSUITE evaluates. Files with the same content are counted once.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from amalthea_uros import check, load
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import AmurosError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.amalthea import details_of
from amalthea_uros.inchron_bridge.basics.comments import noted
from amalthea_uros.inchron_bridge.build import build_project
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.model import Model
from amalthea_uros.services.build_targets import iterations_of
from amalthea_uros.services.subject import open_system
from amalthea_uros.validate import registry
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import RuleProfile
from amalthea_uros.validate.rules.inchron.events import dropped
from amalthea_uros.validate.rules.inchron.stimuli import NOT_CONVERTED

#: What `amuros export` says of an event chain that it only writes to a comment.
_REASON = re.compile(
    r".*an event chain has no place in an INCHRON project(?: \((?P<times>\d+) times\))?: (?P<why>.*); only amuros reads .*"
)
_RULES = list(registry.ids([RuleProfile.INCHRON]))


@dataclass
class Arrivals:
    """What arrives of many files, by construct.

    Attributes
    ----------
    files, failing, refused : all, those at which am2inc fails, and those that cannot be exported
    reasons : why event chains are only in comments
    """

    files: int = 0
    failing: int = 0
    refused: int = 0
    stated: Counter[str] = field(default_factory=Counter)
    imported: Counter[str] = field(default_factory=Counter)
    exported: Counter[str] = field(default_factory=Counter)
    reasons: Counter[str] = field(default_factory=Counter)

    def add(self, path: Path) -> None:
        """Count a file."""
        try:
            model = load(path)
        except AmurosError:
            return
        self.files += 1
        self.stated.update(kind for kind, _ in _constructs(model))
        if any(finding.severity is Severity.ERROR for finding in check(model, _RULES)):
            self.failing += 1
        else:
            lost = dropped(Context(model))
            self.imported.update(kind for kind, element in _constructs(model) if _IMPORTED[kind](element, lost))
        try:
            opened = open_system(path)
            built = build_project(opened.system, details_of(model), iterations_of(opened.system))
        except AmurosError:
            self.refused += 1
            return
        self.exported.update(_exported(built.model))
        for finding in built.findings:
            if found := _REASON.fullmatch(finding.message):
                self.reasons[re.sub(r" '[^']*'", "", found["why"])] += int(found["times"] or 1)


def _constructs(model: Model) -> Iterator[tuple[str, object]]:
    """The constructs of a model, by the names that the table has for them."""
    for element in model.walk():
        match element:
            case am.EventChain():
                yield "event chains", element
            case am.EventChainLatencyConstraint():
                yield "limits of event chains", element
            case am.TimingConstraint() | am.DataAgeConstraint() | am.Requirement():
                yield "other timing constraints and requirements", element
            case am.Stimulus():
                yield "stimuli", element
            case am.Task() | am.ISR():
                yield "tasks and ISRs", element
            case am.Runnable():
                yield "runnables", element
            case am.Label():
                yield "labels", element


#: Whether am2inc converts an object, given the chains that it drops.
_IMPORTED: dict[str, Callable[[object, set], bool]] = {
    "event chains": lambda element, lost: element not in lost,
    "limits of event chains": lambda element, lost: element.scope is not None and element.scope not in lost,
    "other timing constraints and requirements": lambda element, lost: False,
    "stimuli": lambda element, lost: not isinstance(element, NOT_CONVERTED),
    "tasks and ISRs": lambda element, lost: True,
    "runnables": lambda element, lost: True,
    "labels": lambda element, lost: True,
}
#: The classes of a project that need nothing else to count.
_CLASSES = {"Process": "tasks and ISRs", "Function": "runnables", "memory.DataObject": "labels"}


def _exported(project: ProjectObject) -> Iterator[str]:
    yield from (_CLASSES[item.kind] for item in project.walk() if item.kind in _CLASSES)
    yield from ("event chains" for graph in project["eventChains"] if not {"synchronized", "beside"} & noted(graph).keys())
    for item in project["requirements"]:
        if item["evaluate"] and "beside" not in noted(item):
            is_of_chain = item.kind == "requirement.EventChainTimingRequirement" and not item["orSemanticsStart"]
            yield "limits of event chains" if is_of_chain else "other timing constraints and requirements"
    for generator in [each for scenario in project["scenarios"] for each in scenario["generators"]]:
        is_empty = generator.kind == "stimulation.ListBasedGenerator" and not generator["entries"]
        if not is_empty and not generator.name.endswith("PeriodicDriver"):
            yield "stimuli"
    yield from ("stimuli" for connection in project["connections"] if connection.kind == "ActivationConnection")


def count(paths: Iterable[Path]) -> Arrivals:
    """What arrives of some files."""
    arrivals, known = Arrivals(), set()
    for path in paths:
        digest = sha256(path.read_bytes()).digest()
        if digest not in known:
            known.add(digest)
            arrivals.add(path)
    return arrivals


def lines(arrivals: Arrivals) -> Iterator[str]:
    """A table."""
    yield f"{arrivals.files} files: am2inc fails at {arrivals.failing}, amuros cannot export {arrivals.refused}"
    yield ""
    yield "| construct | in the models | by am2inc | by amuros export |"
    yield "|---|---|---|---|"
    for kind in _IMPORTED:
        yield f"| {kind} | {arrivals.stated[kind]:,} | {arrivals.imported[kind]:,} | {arrivals.exported[kind]:,} |"
    yield ""
    yield from (f"event chains in comments only: {number}, as {why}" for why, number in arrivals.reasons.most_common())


if __name__ == "__main__":
    print(*lines(count(sorted(Path(sys.argv[1]).rglob("*.amxmi")))), sep="\n")
