"""Findings about target tools."""

from amalthea_uros.diagnostics import Finding, Severity, ToolEffect
from amalthea_uros.findings.targets import TARGETS, split, summary, target_of
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import RuleProfile

INCHRON, TA = TARGETS


def test_a_target_tool_is_the_profile_with_its_rules():
    for identifier in registry.ids():
        profile = registry.profile_of(identifier)
        assert target_of(identifier) == next((target for target in TARGETS if target.name == profile), None)
    assert {target.name for target in TARGETS} <= set(RuleProfile)


def test_what_concerns_a_tool_counts_only_where_it_is_asked_for():
    findings = [Finding(rule, Severity.ERROR, "") for rule in ("INC-CO-KIND", "TIM-CLOCK", "TA-Misc-Semaphore", "INC-EC-SEQ")]
    importer, clock, semaphore, chain = findings
    assert split(findings, ()) == ([clock], {INCHRON: [importer, chain], TA: [semaphore]})
    assert split(findings, ["inchron"]) == ([importer, clock, chain], {TA: [semaphore]})
    assert split(findings, ["inchron", "ta"]) == (findings, {})


def test_the_summary_counts_by_effect():
    effects = [ToolEffect.DROPS] * 9 + [ToolEffect.CHANGES] * 3 + [ToolEffect.FAILS]
    findings = [Finding("INC-CO-KIND", Severity.WARNING, "", effect=effect) for effect in effects]
    assert summary(INCHRON, findings) == (
        "INCHRON's importer: fails at 1, changes 3, drops 9; amuros check --profile inchron shows them"
    )
