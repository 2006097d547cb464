import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize(
    ("tool", "committed", "pattern"),
    [
        ("generate_schemas.py", "schemas", "amalthea-*.xsd"),
        ("generate_app_schema.py", "schemas", "app.schema.json"),
        ("generate_app_reference.py", "docs/app-yaml-reference", "*.md"),
        ("generate_findings.py", "docs/findings", "*.md"),
        ("generate_rules.py", "docs/rules", "*.md"),
        ("generate_benchmarks.py", "docs", "benchmarks.md"),
        ("generate_metamodel.py", "amalthea_uros/metamodel", "classes*.py"),
    ],
)
def test_what_is_committed_is_what_the_tool_generates(tool, committed, pattern, tmp_path):
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    subprocess.run([sys.executable, ROOT / "tools" / tool, tmp_path], check=True, env=environment)
    generated = {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}
    assert generated == {path.name: path.read_bytes() for path in (ROOT / committed).glob(pattern)}
