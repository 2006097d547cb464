"""The notebooks of the documentation as pages: their cells with the outputs that are stored in them, without any script."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from amalthea_uros._internal.addresses import REPOSITORY

#: Links of a page to a notebook, which lead to its page instead.
LINK = re.compile(r"\]\((notebooks/\w+)\.ipynb\)")
_OUTSIDE = re.compile(r"\]\(\.\./\.\./([^)]+)\)")


def notebook_pages(docs: Path) -> Iterator[tuple[str, str]]:
    """Path and text of each page."""
    for path in sorted((docs / "notebooks").glob("*.ipynb")):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        blocks = [block for cell in cells for block in _blocks(cell)]
        source = f"[The notebook itself]({REPOSITORY}/blob/main/docs/notebooks/{path.name}) is in the repository."
        yield f"notebooks/{path.stem}.md", "\n\n".join([*blocks, source]) + "\n"


def _blocks(cell: dict[str, Any]) -> Iterator[str]:
    text = _text(cell["source"])
    if cell["cell_type"] == "markdown":
        yield _OUTSIDE.sub(rf"]({REPOSITORY}/blob/main/\1)", text)
        return
    yield f"```python\n{text}\n```"
    yield from (_output(output) for output in cell["outputs"])


def _output(output: dict[str, Any]) -> str:
    """What a cell printed as a block, what it displayed as it was displayed."""
    data = output.get("data", {})
    if "text/html" in data:
        return f'<div class="output">{_text(data["text/html"])}</div>'
    return f"```text\n{_text(data.get('text/plain') or output['text']).rstrip()}\n```"


def _text(lines: str | list[str]) -> str:
    return "".join(lines)
