"""The notebooks of the documentation: their outputs are those of today, and their code is typed."""

import subprocess
import sys

import pytest
from support import ROOT

nbformat = pytest.importorskip("nbformat")
pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")

from run_notebooks import NOTEBOOKS, code, executed, text_outputs  # noqa: E402

PYRIGHT = ROOT / "tests" / "node" / "node_modules" / ".bin" / "pyright"


def read(path):
    return nbformat.read(path, as_version=4)


@pytest.mark.early
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_the_outputs_of_a_notebook(path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    found = nbformat.reads(executed(path), as_version=4)
    assert list(text_outputs(found)) == list(text_outputs(read(path)))


@pytest.fixture
def modules(tmp_path):
    """The code of all notebooks."""
    files = [tmp_path / f"{path.stem}.py" for path in NOTEBOOKS]
    for path, file in zip(NOTEBOOKS, files, strict=True):
        file.write_text(code(read(path)))
    return files


@pytest.mark.early
def test_mypy_accepts_the_code(modules):
    command = [sys.executable, "-m", "mypy", "--strict", *map(str, modules)]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert run.returncode == 0, run.stdout


@pytest.mark.skipif(not PYRIGHT.exists(), reason="needs the npm packages of tests/node")
def test_pyright_accepts_the_code(modules, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    command = [str(PYRIGHT), "--pythonpath", sys.executable, *map(str, modules)]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert run.returncode == 0, run.stdout


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_has_nothing_of_one_computer(path):
    text = path.read_text()
    assert 'execution_count": null' in text
    assert not any(folder in text for folder in ("/tmp/", "/home/", "/root/", str(ROOT)))
