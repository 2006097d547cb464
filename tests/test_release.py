"""What is published: distributions without stray files, and statements that agree with each other."""

import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile

import pytest
import yaml
from support import ROOT

from amalthea_uros import __version__
from amalthea_uros._internal.addresses import DOCUMENTATION, REPOSITORY

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
VERSIONS = ["3.11", "3.12", "3.13", "3.14"]


@pytest.fixture(scope="module")
def distributions(tmp_path_factory):
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "hatchling", "build", "--directory", folder]
    subprocess.run(command, check=True, cwd=ROOT, capture_output=True)
    return folder


@pytest.fixture(scope="module")
def in_the_wheel(distributions):
    (wheel,) = distributions.glob("*.whl")
    return zipfile.ZipFile(wheel).namelist()


@pytest.fixture(scope="module")
def in_the_sdist(distributions):
    (sdist,) = distributions.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        return {name.partition("/")[2] for name in archive.getnames()}


def test_the_wheel_has_the_package_and_its_resources_only(in_the_wheel):
    assert {name.partition("/")[0] for name in in_the_wheel} == {"amalthea_uros", f"amuros-{__version__}.dist-info"}
    assert len(in_the_wheel) == len(set(in_the_wheel))
    suffixes = {name.rpartition(".")[2] for name in in_the_wheel if name.startswith("amalthea_uros/")}
    assert suffixes & {"pyc", "amxmi", "md", "so"} == set()
    for name in ("py.typed", "samples/drive-and-lift.yaml", "schemas/app.schema.json", "templates/init/app.yaml"):
        assert f"amalthea_uros/{name}" in in_the_wheel


def test_the_source_distribution_has_what_its_tests_read(in_the_sdist):
    tests = (path.read_text() for path in (ROOT / "tests").rglob("*.py") if "node_modules" not in path.parts)
    named = {name for text in tests for name in re.findall(r'ROOT / "([^"{}/]+)"', text) if (ROOT / name).is_file()}
    assert {"README.md", "CONTRIBUTING.md", "pyproject.toml"} <= named
    assert named - in_the_sdist == set()


def test_the_source_distribution_has_no_stray_files(in_the_sdist):
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
    if tracked.returncode:
        pytest.skip("not in a checkout")
    new = subprocess.run(["git", "ls-files", "-o", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True, check=True)
    assert in_the_sdist - {*tracked.stdout.splitlines(), *new.stdout.splitlines()} == {"PKG-INFO"}


def test_the_addresses_are_the_same_everywhere():
    assert PROJECT["urls"]["Repository"] == REPOSITORY
    assert PROJECT["urls"]["Documentation"] == DOCUMENTATION
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert (citation["repository-code"], citation["url"]) == (REPOSITORY, DOCUMENTATION)
    assert REPOSITORY in (ROOT / "SECURITY.md").read_text()


def test_the_citation_is_of_this_version_and_licence():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert (citation["version"], citation["license"]) == (__version__, PROJECT["license"])


def test_each_python_version_that_is_stated_is_tested():
    prefix = "Programming Language :: Python :: 3."
    assert [f"3.{name.removeprefix(prefix)}" for name in PROJECT["classifiers"] if name.startswith(prefix)] == VERSIONS
    assert PROJECT["requires-python"] == f">={VERSIONS[0]}"
    jobs = yaml.safe_load((ROOT / ".github" / "workflows" / "tests.yml").read_text())["jobs"]
    assert jobs["tests"]["strategy"]["matrix"]["python"] == VERSIONS


@pytest.mark.parametrize("path", sorted((ROOT / ".github" / "workflows").glob("*.yml")), ids=lambda path: path.stem)
def test_a_workflow_calls_targets_that_exist_and_may_do_only_what_it_states(path):
    workflow = yaml.safe_load(path.read_text())
    assert workflow["permissions"] == {"contents": "read"}
    steps = [step for job in workflow["jobs"].values() for step in job["steps"]]
    called = {target for step in steps for target in re.findall(r"^make (\w+)", step.get("run", ""), re.MULTILINE)}
    targets = set(re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    assert called <= targets


def test_the_readme_is_the_page_of_the_package_index(in_the_wheel, distributions):
    (wheel,) = distributions.glob("*.whl")
    (metadata,) = (name for name in in_the_wheel if name.endswith("/METADATA"))
    text = zipfile.ZipFile(wheel).read(metadata).decode()
    assert "Description-Content-Type: text/markdown" in text
    assert (ROOT / "README.md").read_text() in text


def test_each_attack_is_shown_by_tests_that_exist():
    rows = re.findall(r"^\| (?!attack|---).*", (ROOT / "SECURITY.md").read_text(), re.MULTILINE)
    assert len(rows) > 40
    for row in rows:
        shown = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", row.split("|")[-2])
        assert shown, row
        assert [name for path, name in shown if f"def {name}(" not in (ROOT / path).read_text()] == []
