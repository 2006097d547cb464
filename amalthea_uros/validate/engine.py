"""Runs rules over a model, and repairs what can be repaired in exactly one way."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import islice

from amalthea_uros._internal.failures import failure
from amalthea_uros._internal.limits import ADVICE, RULE_FINDINGS
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Severity, ToolEffect
from amalthea_uros.findings.kind import FindingKind
from amalthea_uros.findings.targets import target_of
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.system import System
from amalthea_uros.validate import registry
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelCheck, SystemCheck
from amalthea_uros.validate.system_context import SystemContext

_REPORT = "Report it to the author of the rule, with the model if possible."


def run(model: Model, rules: Iterable[ModelCheck]) -> list[Finding]:
    """The findings of rules; a rule that crashes is reported as a finding."""
    context = Context(model)
    return [finding for rule in rules for finding in _limited(rule, _findings(rule, context))]


def _limited(rule: ModelCheck, findings: Iterator[Finding]) -> Iterator[Finding]:
    """So many findings of a rule as fit into memory, and a finding if there are more, which nobody accepts or suppresses with them."""
    yield from islice(findings, RULE_FINDINGS)
    if next(findings, None) is not None:
        message = f"the rule {rule.id} has more than {RULE_FINDINGS:,} findings; it is not checked further"
        yield Finding("CHK002", _kind_of(rule).severity, message, help=f"Correct those that are shown. {ADVICE}")


def run_system(system: System, rules: Iterable[SystemCheck]) -> list[Finding]:
    """The findings of rules on a system. A rule that crashes is a finding, too."""
    context = SystemContext(system)
    return [finding for rule in rules for finding in _system_findings(rule, context)]


def _system_findings(rule: SystemCheck, context: SystemContext) -> Iterator[Finding]:
    try:
        problems = list(rule.check(context))
    except Exception as error:
        yield Finding("CHK001", Severity.ERROR, f"the rule {rule.id} failed: {failure(error)}", help=_REPORT)
        return
    kind = _kind_of(rule)
    for item, message, name, severity in problems:
        object_name = name or (item.name if isinstance(item, Named) else "")
        yield Finding(rule.id, severity or kind.severity, message, item.origin, kind.remedy, object_name)


def _findings(rule: ModelCheck, context: Context) -> Iterator[Finding]:
    try:
        elements = list(concerned(rule, context))
    except Exception as error:
        yield Finding("CHK001", Severity.ERROR, f"the rule {rule.id} failed: {failure(error)}", help=_REPORT)
        return
    for element in elements:
        try:
            messages = list(islice(rule.check(element, context), RULE_FINDINGS + 1))
        except Exception as error:
            failed = f"the rule {rule.id} failed at this object: {failure(error)}"
            yield _finding("CHK001", Severity.ERROR, failed, element, _REPORT)
            continue
        for message in messages:
            kind = _kind_of(rule)
            graded = message if isinstance(message, Downgraded) else Downgraded(message, kind.severity)
            yield _finding(rule.id, graded.severity, graded.message, element, kind.remedy, _effect(graded, kind))


def _effect(message: Downgraded, kind: FindingKind) -> ToolEffect | None:
    """The effect of the tool that a rule is about; it fails at errors, unless something else is said."""
    if message.effect is not None:
        return message.effect
    target = target_of(kind.id)
    is_failure = target is not None and ToolEffect.FAILS in target.effects and message.severity is Severity.ERROR
    return ToolEffect.FAILS if is_failure else kind.effect


def _kind_of(rule: ModelCheck | SystemCheck) -> FindingKind:
    """The texts of a rule that found something; those of this package are only read then."""
    kind = rule if isinstance(rule, FindingKind) else registry.kind(rule.id)
    assert kind is not None
    return kind


def concerned(rule: ModelCheck, context: Context) -> Iterator[Element]:
    """The objects that a rule checks."""
    versions = [version for version in context.versions if (rule.since or "") <= version <= (rule.until or "9")]
    if rule.among is not None and versions:
        yield from (element for element in rule.among(context) if isinstance(element, rule.target))
        return
    for cls, found in context.by_class(rule.target):
        if any(rule.concerns is None or rule.concerns(cls, version) for version in versions):
            yield from found


def _finding(
    rule: str, severity: Severity, message: str, element: Element, remedy: str, effect: ToolEffect | None = None
) -> Finding:
    document = element.document
    location = document.location_of(element) if document is not None else None
    return Finding(rule, severity, message, location, remedy, element.qualified_name, effect)


@dataclass(frozen=True, slots=True)
class Repairs:
    """The changes to a model.

    Attributes
    ----------
    done : the number of repaired objects by the id of the rule
    changed : the documents that were changed
    rewritten : the changed documents that must be written in canonical form
    """

    done: Counter[str] = field(default_factory=Counter)
    changed: set[Document] = field(default_factory=set)
    rewritten: set[Document] = field(default_factory=set)


def repair(model: Model, rules: Iterable[ModelCheck]) -> Repairs:
    """Repair the findings of rules in a model where possible."""
    repairs = Repairs()
    for rule in rules:
        if rule.fix is None and not rule.in_canonical_form:
            continue
        # A new context, because earlier rules may have changed the model.
        context = Context(model)
        for element in list(_with_findings(rule, context)):
            document = element.document
            if document is not None and (rule.fix is None or rule.fix(element, context)):
                repairs.done[rule.id] += 1
                repairs.changed.add(document)
                if rule.in_canonical_form:
                    repairs.rewritten.add(document)
    return repairs


def _with_findings(rule: ModelCheck, context: Context) -> Iterator[Element]:
    for element in concerned(rule, context):
        try:
            if any(rule.check(element, context)):
                yield element
        except Exception:  # a bug in the rule, reported when the rule is run
            continue
