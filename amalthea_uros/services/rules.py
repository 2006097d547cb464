"""The rules of `amuros check`, and kinds of findings by their ids."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings import catalogue
from amalthea_uros.findings.kind import FindingKind
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import RuleProfile
from amalthea_uros.validate.selection import select


@dataclass(frozen=True, slots=True)
class RulesResult:
    """Rules in the order of their profiles."""

    rules: tuple[FindingKind, ...]


def find_rules(
    patterns: Iterable[str] = (),
    *,
    profiles: Iterable[RuleProfile] = (),
    severities: Iterable[Severity] = (),
    text: str = "",
) -> RulesResult:
    """The rules that meet all of some conditions.

    Parameters
    ----------
    patterns : ids, or the first letters of ids
    text : part of what a rule says, in any case

    Raises
    ------
    InvalidArgumentError : a pattern matches no rule.
    """
    wanted = frozenset(severities) or frozenset(Severity)
    rules = filter(None, map(registry.kind, select(profiles, patterns, ()).rules()))
    return RulesResult(tuple(rule for rule in rules if rule.severity in wanted and text.casefold() in _words(rule)))


def _words(rule: FindingKind) -> str:
    return " ".join((rule.id, rule.title, rule.rationale, rule.remedy)).casefold()


def find_kind(identifier: str) -> FindingKind:
    """A rule or another kind of finding by its id, in any case.

    Raises
    ------
    InvalidArgumentError : there is none.
    """
    known = [*registry.ids(), *catalogue.ids()]
    found = next((one for one in known if one.casefold() == identifier.casefold()), None)
    kind = registry.kind(found) if found is not None else None
    if kind is None:
        advice = did_you_mean(identifier, known) or "`amuros rules` lists the rules"
        raise InvalidArgumentError(f"unknown rule or finding {identifier!r}; {advice}")
    return kind
