"""Target tools: findings about a tool that a project may not use are summed up in one line unless it is asked for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Severity, ToolEffect


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetTool:
    """A tool for which models are written.

    Attributes
    ----------
    name : also that of the profile with its rules
    title : how sentences name it
    prefix : with which the ids of its rules start
    effects : what findings of each effect, or else of each severity, mean for it
    """

    name: str
    title: str
    prefix: str
    effects: Mapping[ToolEffect | Severity, str] = field(hash=False)


TARGETS = (
    TargetTool(
        name="inchron",
        title="INCHRON's importer",
        prefix="INC-",
        effects={
            ToolEffect.FAILS: "fails at",
            ToolEffect.CHANGES: "changes",
            ToolEffect.DROPS: "drops",
            ToolEffect.KEEPS: "takes as they are",
        },
    ),
    TargetTool(
        name="ta",
        title="TA tools",
        prefix="TA-",
        effects={Severity.ERROR: "refuse", Severity.WARNING: "warn of", Severity.INFO: "note"},
    ),
)


def target_of(identifier: str) -> TargetTool | None:
    """The tool that a rule is about, None if it is about the model itself."""
    return next((target for target in TARGETS if identifier.startswith(target.prefix)), None)


def split(findings: Iterable[Finding], asked: Collection[str]) -> tuple[list[Finding], dict[TargetTool, list[Finding]]]:
    """The findings that count, and those about target tools that nobody asked for.

    Parameters
    ----------
    asked : names of target tools
    """
    counting: list[Finding] = []
    others: dict[str, list[Finding]] = {}
    for finding in findings:
        target = target_of(finding.rule)
        if target is None or target.name in asked:
            counting.append(finding)
        else:
            others.setdefault(target.name, []).append(finding)
    return counting, {target: others[target.name] for target in TARGETS if target.name in others}


def summary(target: TargetTool, findings: Iterable[Finding]) -> str:
    """One line about what a tool makes of a model.

    >>> from amalthea_uros.diagnostics import Finding, Severity, ToolEffect
    >>> summary(TARGETS[0], [Finding("INC-CO-KIND", Severity.WARNING, "'C' is dropped", effect=ToolEffect.DROPS)])
    "INCHRON's importer: drops 1; amuros check --profile inchron shows them"
    """
    count = Counter(finding.effect or finding.severity for finding in findings)
    effects = [f"{verb} {count[effect]}" for effect, verb in target.effects.items() if count[effect]]
    return f"{target.title}: {', '.join(effects)}; amuros check --profile {target.name} shows them"
