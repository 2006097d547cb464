"""What is in the code but not in the description: nothing is dropped without a word."""

from __future__ import annotations

import re
from collections.abc import Iterator

from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.source.entities import CREATIONS
from amalthea_uros.source.executors import ACTIONS, SPINS
from amalthea_uros.source.facts import CodeFacts
from amalthea_uros.source.syntax import descendants
from amalthea_uros.source.walk import CodeWalk

#: Functions that change nothing in the description.
_HARMLESS = re.compile(
    r"rclc_(support_\w+|\w+_fini|executor_prepare|executor_get_zero\w*|lifecycle_init_\w+|parameter_\w+|add_parameter\w*|"
    r"action_(publish_feedback|send_result|server_goal_\w+|send_goal_request)|create_\w+|node_fini|set_parameter\w*|"
    r"lifecycle_\w+|delete_parameter)"
)
_CALL = re.compile(rb"\brclc_\w+(?=\s*\()")


def not_understood(walk: CodeWalk, facts: CodeFacts) -> Iterator[Finding]:
    """Calls of unknown functions, code that could not be parsed, and code that is compiled under unknown conditions."""
    if not facts.entities and not facts.executors:
        advice = "Give the files in which rclc_node_init_default and rclc_executor_init are called."
        yield Finding("IMP019", Severity.ERROR, "no entity or executor of micro-ROS is created in these files", None, advice)
    known = CREATIONS.keys() | ACTIONS.keys() | SPINS
    for call in walk.calls:
        if call.name.startswith("rclc_") and call.name not in known and not _HARMLESS.fullmatch(call.name):
            message = f"'{call.name}' is not understood; what it does is not in the description"
            yield Finding("IMP005", Severity.WARNING, message, call.place, "Add what it does to the description by hand.")
        elif call.uncertain and call.name in known:
            message = f"'{call.name}' is compiled under a condition that the sources do not decide; it is taken as compiled"
            yield Finding("IMP015", Severity.INFO, message, call.place, "Remove it from the description if it is not compiled.")
    yield from _unread(walk)


def _unread(walk: CodeWalk) -> Iterator[Finding]:
    """Calls in the text that no path through the code led to."""
    for file, root in walk.program.files:
        ignored = [(start, end) for path, start, end in walk.inactive if path == str(file.path)]
        read = {start for path, start in walk.seen if path == str(file.path)}
        if _CALL.search(file.text) is None:
            continue
        for node in descendants(root):
            if node.type in ("comment", "string_literal", "preproc_def", "function_declarator"):
                ignored.append((node.start_byte, node.end_byte))
        for match in _CALL.finditer(file.text):
            position = match.start()
            if position not in read and not any(start <= position < end for start, end in ignored):
                row = file.text.count(b"\n", 0, position)
                place = file.location(row, position - (file.text.rfind(b"\n", 0, position) + 1))
                message = f"'{match[0].decode()}' is in code that is not understood; it is not in the description"
                yield Finding("IMP003", Severity.WARNING, message, place, "Add what it does to the description by hand.")
