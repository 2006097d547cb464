"""Write docs/rules, a page for each profile of rules: python tools/generate_rules.py [FOLDER]"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import RuleProfile

TITLES = {
    RuleProfile.SCHEMA: "Rules of the XML schema",
    RuleProfile.EMF: "Rules of EMF",
    RuleProfile.APP4MC: "Rules of APP4MC",
    RuleProfile.TA: "Rules of the TA tools",
    RuleProfile.INCHRON: "Rules of INCHRON's importer",
    RuleProfile.TIMING: "Rules on timing",
    RuleProfile.MICRO_ROS: "Rules of the micro-ROS model",
}


def main(folder: Path) -> None:
    for profile, title in TITLES.items():
        lines = (
            f"# {title}\n",
            f"`amuros check --profile {profile}` [checks](../check.md) these rules.\n",
            *_rows(profile),
            "",
        )
        (folder / f"{profile}.md").write_text("\n".join(lines))


def _rows(profile: RuleProfile) -> Iterator[str]:
    kinds = [kind for kind in map(registry.kind, registry.ids((profile,))) if kind is not None]
    has_effects = any(kind.effect for kind in kinds)
    yield (
        "| rule | severity | effect | problem | why it matters |"
        if has_effects
        else "| rule | severity | problem | why it matters |"
    )
    yield f"|---|---|{'---|' if has_effects else ''}---|---|"
    for kind in kinds:
        effect = f" {_effects(kind)} |" if has_effects else ""
        yield f"| {kind.id} | {kind.severity} |{effect} {kind.title} | {kind.rationale} |"


def _effects(kind: FindingKind) -> str:
    """What a tool does, in the worst case first."""
    return ", ".join(["fails"] * (kind.severity is Severity.ERROR) + [kind.effect] * (kind.effect is not None))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent / "docs" / "rules")
