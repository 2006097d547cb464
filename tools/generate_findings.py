"""Write docs/findings, a page for each family of findings that no rule reports: python tools/generate_findings.py [FOLDER]"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from amalthea_uros.findings import catalogue
from amalthea_uros.findings.kind import FindingKind

INDEX = """# Findings

Besides [the rules of `amuros check`](../check.md), reading, building and analysing report findings of their own. `amuros explain ID`
shows the entry of each, with an example where there is one. Errors XMI001 to XMI006 end reading; with all others the model is read and
can be written back. Frequent findings of reading are reported once, with their number; all errors of an app.yaml are reported in one
run, up to 100.

| ids | findings of |
|---|---|
"""


def main(folder: Path) -> None:
    families = catalogue.FAMILIES.items()
    rows = (f"| {family} | [{title}]({family.lower()}.md) |\n" for family, title in families)
    (folder / "index.md").write_text(INDEX + "".join(rows))
    for family, title in families:
        (folder / f"{family.lower()}.md").write_text("\n".join((f"# {title}\n", *_rows(catalogue.kinds(family)), "")))


def _rows(kinds: tuple[FindingKind, ...]) -> Iterator[str]:
    yield "| id | severity | what is wrong | why it matters | what to do |"
    yield "|---|---|---|---|---|"
    for kind in kinds:
        yield f"| {kind.id} | {kind.severity} | {kind.title} | {kind.rationale} | {kind.remedy} |"


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent / "docs" / "findings")
