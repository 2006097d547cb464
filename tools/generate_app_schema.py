"""Generate `schemas/app.schema.json` from the sections of the package.

Usage: python tools/generate_app_schema.py [TARGET]
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from templating import ROOT

from amalthea_uros.spec.description import json_schema


def main(target: Path) -> None:
    text = json.dumps(json_schema(), indent=2, ensure_ascii=False) + "\n"
    (target / "app.schema.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "schemas")
