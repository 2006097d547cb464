"""Findings and what is done about them as documents: flaws, rules, repairs; and the section of a report."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from difflib import unified_diff
from io import StringIO
from typing import TYPE_CHECKING

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Finding, Severity, worst
from amalthea_uros.findings.targets import summary
from amalthea_uros.report.basics.document import (
    Block,
    Folded,
    Lead,
    Listing,
    ResultDocument,
    Section,
    Sentences,
    ShownFinding,
    document,
    lines,
    section,
    table,
)
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.wording.findings import findings_text, joined, profile_name

if TYPE_CHECKING:
    from amalthea_uros.findings.grouping import FindingGroup
    from amalthea_uros.findings.presentation import Presentation
    from amalthea_uros.services.check import CheckResult, CheckStatistics
    from amalthea_uros.services.files import FileChange, FilesDiff
    from amalthea_uros.services.fix import FixResult
    from amalthea_uros.services.format import FormatResult
    from amalthea_uros.services.generate import MetaCheck
    from amalthea_uros.services.report import ReportContent
    from amalthea_uros.services.rules import RulesResult

#: At most so many findings of a rule are shown; nobody reads more, and the others are counted.
SHOWN = 100
#: Of each rule so many findings are in a report.
_MOST = 20
_SEVERITIES = tuple(Severity)


def check_document(result: CheckResult) -> ResultDocument:
    """Each flaw with its line, of a rule that fires very often the first ones; and the number of all."""
    groups = result.presentation.groups
    count: Counter[str] = Counter()
    flaws: list[Block] = []
    for group in groups:
        count[group.shown.rule] += 1
        if count[group.shown.rule] <= SHOWN:
            flaws.append(ShownFinding(group.shown, dict(_notes(group))))
    hidden = (
        f"{rule}: {number - SHOWN} more not shown; --output json has all of them"
        for rule, number in count.items()
        if number > SHOWN
    )
    errors = [group.shown for group in groups if group.shown.severity is Severity.ERROR]
    more = f"{len(errors) - SHOWN} more errors not shown; --output json has all of them" if len(errors) > SHOWN else ""
    total = findings_text(result.presentation.shown)
    found = section("", *flaws, lines(*hidden, *_targets(result.presentation), total))
    return document([found], kept=[*(ShownFinding(error, {}) for error in errors[:SHOWN]), lines(more, total)])


def _notes(group: FindingGroup) -> Iterator[tuple[str, str]]:
    """The other rules that report the same flaw, and how much follows from it."""
    if group.also:
        yield "also", ", ".join(group.also)
    if group.consequences:
        count = Counter(finding.rule for finding in group.consequences)
        yield "consequences", ", ".join(f"{rule} ({number})" for rule, number in count.items())


def _targets(presentation: Presentation) -> list[str]:
    """A line for each target tool that nobody asked for."""
    return [summary(target, (group.shown for group in groups)) for target, groups in presentation.targets.items()]


def statistics_document(statistics: CheckStatistics) -> ResultDocument:
    """A table of the rules, the most frequent first."""
    presentation = statistics.result.presentation
    count = Counter((finding.rule, str(finding.severity)) for finding in presentation.shown)
    rows = [(*key, f"{number}") for key, number in count.most_common()]
    total = lines(*_targets(presentation), findings_text(presentation.shown))
    return document([section("", table("", ("rule", "severity", ">findings"), rows), total)])


def rules_document(result: RulesResult) -> ResultDocument:
    """A row for each rule."""
    rows = [(rule.id, str(rule.severity), profile_name(rule.id), rule.title) for rule in result.rules]
    rules = table("", ("rule", "severity", "profile", "what is wrong"), rows)
    return document([section("", rules or lines("no rules"))])


def meta_document(result: MetaCheck) -> ResultDocument:
    """Whether a `colcon.meta` fits an application; its findings are shown where those of all commands are."""
    found = findings_text(result.findings) if result.findings else ""
    outcome = found or f"holds for {result.description}, and nothing is larger than needed"
    return document([section("", lines(Lead(str(result.path), f": {outcome}")))])


def fix_document(result: FixResult) -> ResultDocument:
    """What was repaired: a line for each rule and model."""
    from amalthea_uros.metamodel.versions import spelled

    done = "repaired" if result.is_written else "would be repaired"
    repaired = [
        f"{joined(model.paths)}: {rule} {done} in {counted(number, 'object')}"
        for model in result.models
        for rule, number in model.repaired.items()
    ]
    not_repaired = [
        f"{path}: a description is not repaired, only its author knows what is meant" for path in result.descriptions
    ]
    not_repaired += [
        f"{path}: a model of {spelled(version)} is not repaired; migrate it first: amuros migrate {path}"
        for path, version in result.older
    ]
    return document([section("", lines(*repaired, *not_repaired))])


def format_document(result: FormatResult) -> ResultDocument:
    """Which files were not in canonical form."""
    done = "rewritten" if result.is_written else "would be rewritten"
    return document([section("", lines(*(f"{file.path}: {done}" for file in result.changed)))])


def patch_document(diff: FilesDiff) -> ResultDocument:
    """What changes in files: a unified diff for each of them, as people and `patch` read it."""
    return document([section("", Listing("", [line for file in diff.files for line in _changed(file, diff.label)]))])


def _changed(file: FileChange, label: str) -> Iterator[str]:
    names = visible(str(file.path)), visible(f"{file.path} ({label})")
    # Only a line feed ends a line, as for `patch`.
    before, after = (StringIO(text, newline="\n").readlines() for text in (file.before, file.after))
    for line in unified_diff(before, after, *names, n=1):
        yield line.removesuffix("\n")
        if not line.endswith("\n"):
            yield r"\ No newline at end of file"


def findings_section(content: ReportContent) -> Section | None:
    """Each rule with its findings, the severest first."""
    checked = content.check.shown if content.check is not None else []
    found = list(dict.fromkeys((*checked, *content.findings)))
    by_rule: dict[str, list[Finding]] = defaultdict(list)
    for finding in found:
        by_rule[finding.rule].append(finding)
    ordered = sorted(by_rule.items(), key=lambda item: (_SEVERITIES.index(worst(item[1]) or Severity.INFO), item[0]))
    others = _targets(content.check) if content.check is not None else []
    lead = "What the rules report about the model, with what to do about it; amuros explain RULE says more."
    blocks: list[Block] = [Sentences([_total(content, found)]), *(_folded(rule, findings) for rule, findings in ordered)]
    return section("Findings", *blocks, Sentences(others), lead=lead, anchor="findings")


def _total(content: ReportContent, found: Sequence[Finding]) -> str:
    total = f"{findings_text(found)[:1].upper()}{findings_text(found)[1:]}."
    if content.check is None:
        return f"{total} The rules check files and models, not systems of the library."
    return f"{total} The files were checked without the changes." if content.before is not None else total


def _folded(rule: str, findings: Sequence[Finding]) -> Folded:
    # Only reports have these; `amuros check` does without analyses.
    from amalthea_uros.report.wording.cells import badge
    from amalthea_uros.validate import registry

    kind = registry.kind(rule)
    title = f"{rule}{f': {kind.title}' if kind is not None else ''} ({counted(len(findings), 'finding')})"
    rows = [(str(each.location or each.object or "-"), each.message, each.help) for each in findings[:_MOST]]
    caption = f"Findings of {rule}" + (f", the first {_MOST} of {len(findings):,}" if len(findings) > _MOST else "")
    return Folded(title, [table(caption, ("where", "what", "help"), rows)], badge(worst(findings) or Severity.INFO))
