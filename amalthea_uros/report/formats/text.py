"""Text for people; each result has a module in `report/text`, with a function `write`.

Where `write_closing` is beside it, that is what remains for somebody who wants no more than the outcome.
"""

from __future__ import annotations

from typing import IO

from amalthea_uros.report.by_result import module_for, rendered_in
from amalthea_uros.report.display import is_brief
from amalthea_uros.report.terminal import Terminal

RENDERS = rendered_in("text")


def write(result: object, stream: IO[str]) -> None:
    """Write tables and sentences, in colour on a terminal."""
    module = module_for(result, "text")
    write_result = getattr(module, "write_closing", module.write) if is_brief(stream) else module.write
    write_result(result, Terminal(stream))
