"""Execute the notebooks of the documentation, and store their outputs in them.

Notebooks are executed in a folder with the samples. What differs from run to run, or from computer to computer, is not stored.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import nbformat
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parent.parent
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


def executed(path: Path) -> str:
    """The text of a notebook with its outputs."""
    notebook = nbformat.read(path, as_version=4)
    with TemporaryDirectory() as folder:
        for sample in (ROOT / "samples").iterdir():
            if sample.is_file():
                shutil.copy(sample, folder)
        NotebookClient(notebook, timeout=120, resources={"metadata": {"path": folder}}).execute()
    return normalised(notebook)


def normalised(notebook: Any) -> str:
    """The text of a notebook without counters, times and ids."""
    for cell in notebook.cells:
        cell.pop("id", None)
        cell.metadata = {}
        if cell.cell_type == "code":
            cell.execution_count = None
            cell.outputs = _joined(cell.outputs)
            for output in cell.outputs:
                output.pop("execution_count", None)
                if output.output_type == "execute_result":
                    output.output_type = "display_data"
    notebook.metadata = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    notebook.nbformat, notebook.nbformat_minor = 4, 4
    text: str = nbformat.writes(notebook, version=nbformat.NO_CONVERT)
    return text + "\n"


def _joined(outputs: list[Any]) -> list[Any]:
    """Outputs in which printed text is one piece; how a kernel cuts it depends on the time."""
    found: list[Any] = []
    for output in outputs:
        if found and output.output_type == found[-1].output_type == "stream" and output.name == found[-1].name:
            found[-1].text += output.text
        else:
            found.append(output)
    return found


def text_outputs(notebook: Any) -> Iterator[str]:
    """What a person reads of the outputs of a notebook."""
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            yield output.text if output.output_type == "stream" else output.data["text/plain"]


def code(notebook: Any) -> str:
    """The code cells of a notebook as one module."""
    return "\n\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code") + "\n"


def main(paths: list[Path]) -> None:
    """Rewrite notebooks."""
    for path in paths:
        path.write_text(executed(path), encoding="utf-8")


if __name__ == "__main__":
    main([Path(argument) for argument in sys.argv[1:]] or NOTEBOOKS)
