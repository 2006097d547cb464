"""Every example of the pages is executed, and every output compared; a block with a title is a file of the examples after it."""

import re
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from command import printed
from command_server import warm_up
from effort import IS_THOROUGH
from shared_analyses import share
from support import ROOT

from amalthea_uros._internal.addresses import DOCUMENTATION, REPOSITORY
from amalthea_uros.validate import registry

FOLDERS = (ROOT / "docs", ROOT / "benchmarks")
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(page for folder in FOLDERS for page in sorted(folder.rglob("*.md")))]
BLOCK = re.compile(r"^```(?:(python|console)|\w+ title=\"([^\"]+)\")\n(.*?)^```", re.DOTALL | re.MULTILINE)
WITH_EXAMPLES = [page for page in PAGES if re.search("^```(?:python|console)$", page.read_text(), re.MULTILINE)]


@pytest.fixture
def samples(tmp_path, monkeypatch):
    for path in (ROOT / "samples").iterdir():
        if path.is_file():
            shutil.copy(path, tmp_path)
        else:
            shutil.copytree(path, tmp_path / path.name)
    monkeypatch.chdir(tmp_path)
    if not IS_THOROUGH:
        warm_up()
        share(monkeypatch.setattr)
    return tmp_path


@pytest.mark.early
@pytest.mark.parametrize("page", WITH_EXAMPLES, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_examples_of_a_page(page, samples):
    names: dict[str, object] = {}
    for language, file, text in BLOCK.findall(page.read_text()):
        if file:
            Path(file).write_text(text)
            continue
        if language == "python":
            exec(compile(text, str(page), "exec"), names)
            continue
        command, _, expected = text.partition("\n")
        assert printed(command.removeprefix("$ ")) == expected


def test_the_figures_that_the_readme_states_beside_commands(samples):
    printed("amuros init --example bodas-test-advanced")
    lines = re.findall(r"^(amuros (?:analyze|report|simulate) .*?) +# (.*)$", (ROOT / "README.md").read_text(), re.MULTILINE)
    assert lines
    for command, comment in lines:
        output = printed(command)
        assert [figure for figure in re.findall(r"[\d.]+(?: [mu]s|%)", comment) if figure not in output] == [], command


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_links_of_a_page(page):
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text()):
        file = linked_file(page, target)
        assert file is None or file.exists(), target


def linked_file(page: Path, target: str) -> Path | None:
    """The file that a link leads to, also where it is an address of the project; None for addresses of others."""
    for address in (f"{REPOSITORY}/blob/main/", f"{REPOSITORY}/raw/main/"):
        if target.startswith(address):
            return ROOT / target.removeprefix(address)
    if target.startswith(f"{DOCUMENTATION}/"):
        return ROOT / "docs" / (target.removeprefix(f"{DOCUMENTATION}/").rstrip("/") + ".md")
    return None if target.startswith("https://") else page.parent / target


def test_the_readme_has_no_relative_link():
    # It is also the page of the package index, where they lead nowhere.
    targets = re.findall(r"\]\(([^)]+)\)", (ROOT / "README.md").read_text())
    assert [target for target in targets if not target.startswith("https://")] == []


def test_the_number_of_rules():
    number = len(list(registry.ids()))
    assert "More than two hundred rules" in (ROOT / "README.md").read_text()
    assert 200 < number < 220


def test_the_sample_is_what_its_script_builds(tmp_path):
    subprocess.run([sys.executable, ROOT / "samples" / "executor.py", tmp_path / "executor.amxmi"], check=True)
    assert (tmp_path / "executor.amxmi").read_bytes() == (ROOT / "samples" / "executor.amxmi").read_bytes()


@pytest.mark.parametrize(
    ("picture", "command"),
    [
        ("info.svg", ["info", "executor.amxmi"]),
        ("analyze.svg", ["analyze", "bodas-test-advanced.yaml"]),
        ("build.svg", ["build", "bodas-test-advanced.yaml"]),
        ("check.svg", ["check", "--profile", "inchron", "bodas-test-hardware.yaml"]),
    ],
)
def test_the_picture_shows_what_is_printed(picture, command, tmp_path):
    subprocess.run([sys.executable, ROOT / "tools" / "draw_terminal.py", tmp_path / picture, *command], check=True)
    assert (tmp_path / picture).read_text() == (ROOT / "docs" / "images" / picture).read_text()


def test_every_picture_can_be_drawn():
    for picture in sorted((ROOT / "docs").rglob("*.svg")):
        ElementTree.parse(picture)


def test_the_gantt_chart_is_what_the_command_draws(samples):
    printed("amuros simulate bodas-test-advanced.yaml --gantt gantt.svg --chain factor-to-output")
    assert Path("gantt.svg").read_text() == (ROOT / "docs" / "images" / "simulation-gantt.svg").read_text()
