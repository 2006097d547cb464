"""The pipelines of docs/ci.md: each is YAML of the form that its host reads, and its commands succeed, in order."""

import re
import shlex
import shutil
from collections.abc import Iterator
from typing import Any

import pytest
import yaml
from command import amuros
from support import ROOT

FILE = re.compile(r"\w+\.(?:html|json|md|sarif|xml)\b")
BLOCKS = re.findall(r"```yaml\n(.*?)```", (ROOT / "docs" / "ci.md").read_text(), re.DOTALL)


@pytest.fixture
def folder(tmp_path):
    for path in (ROOT / "samples").iterdir():
        if path.is_file():
            shutil.copy(path, tmp_path)
    amuros("check", "bodas-test-simple.yaml", "--profile", "inchron,ta", "--write-baseline", "accepted.json", cwd=tmp_path)
    return tmp_path


def commands(found: Any) -> Iterator[str]:
    """What a pipeline runs: `run` of GitHub, `script` of GitLab."""
    for job in found.get("jobs", {}).values():
        yield from (step["run"] for step in job["steps"] if "run" in step)
    for job in found.values():
        yield from job.get("script", ()) if isinstance(job, dict) else ()


@pytest.mark.parametrize("text", BLOCKS)
def test_the_commands_of_a_pipeline_succeed(text, folder):
    for line in commands(yaml.safe_load(text)):
        program, *words = shlex.split(line)
        if program == "amuros":
            run = amuros(*words, cwd=folder)
            assert run.returncode == 0, f"{line}: {run.stderr}"
        else:
            assert line.startswith(("pip install amuros", "gh pr comment "))


def test_what_a_pipeline_uploads_is_written():
    lines = [line for block in BLOCKS for line in block.splitlines()]
    written, kept = (
        {name for line in lines if ("amuros" in line) is by_us for name in FILE.findall(line)} for by_us in (True, False)
    )
    assert {"findings.sarif", "report.html", "report.md", "timing.json"} <= kept <= written


def test_the_hooks_are_those_of_the_repository():
    (hooks,) = (yaml.safe_load(block) for block in BLOCKS if "repos:" in block)
    offered = {hook["id"] for hook in yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())}
    assert {hook["id"] for repo in hooks["repos"] for hook in repo["hooks"]} <= offered
