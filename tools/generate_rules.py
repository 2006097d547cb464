"""Write the table of all rules into docs/check.md: python tools/generate_rules.py"""

from __future__ import annotations

from pathlib import Path

from amalthea_uros.validate import registry

PAGE = Path(__file__).parent.parent / "docs" / "check.md"
HEADING = "## The rules\n"


def main() -> None:
    text = PAGE.read_text()
    rows = ["| rule | severity | profile | problem | why it matters |", "|---|---|---|---|---|"]
    for identifier in registry.ids():
        rule = registry.rule(identifier)
        rows.append(f"| {rule.id} | {rule.severity} | {registry.profile_of(identifier)} | {rule.title} | {rule.rationale} |")
    PAGE.write_text(text[: text.index(HEADING)] + HEADING + "\n" + "\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
