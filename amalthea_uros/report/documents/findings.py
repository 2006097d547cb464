"""The findings of a report by rule, the severest first."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from amalthea_uros._internal.plural import counted
from amalthea_uros.diagnostics import Finding, Severity, worst
from amalthea_uros.findings.targets import summary
from amalthea_uros.report.basics.document import (
    Block,
    Folded,
    Section,
    Sentences,
    table,
)
from amalthea_uros.report.wording.cells import badge
from amalthea_uros.report.wording.findings import findings_text
from amalthea_uros.services.report import ReportContent
from amalthea_uros.validate import registry

#: Of each rule so many findings are listed.
_MOST = 20


_SEVERITIES = tuple(Severity)


def findings_section(content: ReportContent) -> Section | None:
    """Each rule with its findings, the severest first."""
    checked = content.check.shown if content.check is not None else []
    found = list(dict.fromkeys((*checked, *content.findings)))
    blocks: list[Block] = [Sentences([_total(content, found)])]
    by_rule: dict[str, list[Finding]] = defaultdict(list)
    for finding in found:
        by_rule[finding.rule].append(finding)
    ordered = sorted(by_rule.items(), key=lambda item: (_SEVERITIES.index(worst(item[1]) or Severity.INFO), item[0]))
    blocks += [_folded(rule, findings) for rule, findings in ordered]
    if content.check is not None:
        others = [summary(target, (group.shown for group in groups)) for target, groups in content.check.targets.items()]
        if others:
            blocks.append(Sentences(others))
    lead = "What the rules report about the model, with what to do about it; amuros explain RULE says more."
    return Section("findings", "Findings", lead, blocks)


def _total(content: ReportContent, found: Sequence[Finding]) -> str:
    total = f"{findings_text(found)[:1].upper()}{findings_text(found)[1:]}."
    if content.check is None:
        return f"{total} The rules check files and models, not systems of the library."
    return f"{total} The files were checked without the changes." if content.before is not None else total


def _folded(rule: str, findings: Sequence[Finding]) -> Folded:
    kind = registry.kind(rule)
    severity = worst(findings) or Severity.INFO
    title = f"{rule}{f': {kind.title}' if kind is not None else ''} ({counted(len(findings), 'finding')})"
    rows = [(str(each.location or each.object or "-"), each.message, each.help) for each in findings[:_MOST]]
    caption = f"Findings of {rule}" + (f", the first {_MOST} of {len(findings):,}" if len(findings) > _MOST else "")
    return Folded(title, [table(caption, ("where", "what", "help"), rows)], badge(severity))
