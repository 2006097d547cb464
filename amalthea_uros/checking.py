"""Models and descriptions checked by rules: what `amuros check` does, and scripts too."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from os import PathLike
from pathlib import Path

from amalthea_uros.diagnostics import Finding, by_place
from amalthea_uros.findings.grouping import Group
from amalthea_uros.findings.presentation import present
from amalthea_uros.findings.targets import Target
from amalthea_uros.garbage import paused_garbage_collection
from amalthea_uros.metamodel.model import Model
from amalthea_uros.validate import registry
from amalthea_uros.validate.engine import run, run_system
from amalthea_uros.validate.repair import repair
from amalthea_uros.validate.rule import ModelRule, Profile, SystemRule

StrPath = str | PathLike[str]


def check(model: Model, rules: Iterable[str] | None = None) -> list[Finding]:
    """What is wrong with a model, by file and line.

    Parameters
    ----------
    rules : ids of the rules; all of them if none are given

    Raises
    ------
    KeyError : there is no rule of an id.
    """
    chosen = list(registry.ids() if rules is None else rules)
    with paused_garbage_collection():
        rules_chosen = [registry.rule(identifier) for identifier in chosen]
        findings = run(model, [rule for rule in rules_chosen if isinstance(rule, ModelRule)])
        system_rules = [rule for rule in rules_chosen if isinstance(rule, SystemRule)]
        if system_rules:
            from amalthea_uros.bridge.extract import extract

            findings += run_system(extract(model).system, system_rules)
        if not set(chosen).isdisjoint(registry.ids([Profile.SCHEMA])):
            from amalthea_uros.xmi.schema_findings import schema_findings

            told = [finding for document in model.documents for finding in schema_findings(document)]
            findings += [finding for finding in told if finding.rule in chosen]
    return sorted(findings, key=by_place)


def target_groups(model: Model, targets: Iterable[str]) -> Mapping[Target, Sequence[Group]]:
    """What target tools make of a model, by flaw.

    Parameters
    ----------
    targets : names of the tools
    """
    return present(check(model, registry.ids(map(Profile, targets)))).targets


def check_files(paths: Sequence[StrPath], rules: Collection[str]) -> list[Finding]:
    """What is wrong with an `app.yaml`, or with AMALTHEA models; what is odd about the files themselves included.

    Parameters
    ----------
    rules : ids of the rules

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    """
    model, told = _read(paths)
    general = [finding for finding in told if _is_wanted(finding, rules)]
    return sorted([*general, *check(model, rules)], key=by_place)


def fix_files(paths: Sequence[StrPath], rules: Iterable[str]) -> Counter[str]:
    """Repair what rules find in AMALTHEA models and can be repaired in one way only, and write the files that changed.

    Parameters
    ----------
    rules : ids of the rules

    Returns
    -------
    Counter : how many objects were repaired, by the id of the rule.

    Raises
    ------
    ReadError : a file cannot be read.
    WriteError : a file cannot be written; then none was touched.
    """
    from amalthea_uros.xmi.load import load
    from amalthea_uros.xmi.save import save_documents

    repairs = repair(load(*paths), [rule for rule in map(registry.rule, rules) if isinstance(rule, ModelRule)])
    save_documents(repairs.changed, repairs.rewritten)
    return repairs.done


def is_description(path: StrPath) -> bool:
    """Whether a file is an `app.yaml`, by its name."""
    return Path(path).suffix in (".yaml", ".yml")


def _read(paths: Sequence[StrPath]) -> tuple[Model, Sequence[Finding]]:
    """The model of files, or the one that a description becomes, whose objects know its lines; and what there was to say."""
    if len(paths) == 1 and is_description(paths[0]):
        from amalthea_uros.pipeline import build

        built = build(paths[0])
        return built.model, built.assembly.findings
    from amalthea_uros.xmi.load import load

    model = load(*paths)
    return model, model.findings


def _is_wanted(finding: Finding, rules: Collection[str]) -> bool:
    """Whether a finding of reading or building belongs to no rule, or to one that is wanted and has no check of its own."""
    profile = registry.profile_of(finding.rule)
    return profile is None or (profile is Profile.MICRO_ROS and finding.rule in rules)
