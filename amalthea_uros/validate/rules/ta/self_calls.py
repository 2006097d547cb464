"""Runnables that call themselves."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable, RunnableCall, ServerCall
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule


def _check_call(element: RunnableCall, context: Context) -> Iterator[str]:
    caller = element.enclosing(Runnable)
    if caller is not None and element.runnable is caller:
        yield f"{caller.name!r} calls itself"


def _check_server_call(element: ServerCall, context: Context) -> Iterator[str]:
    caller = element.enclosing(Runnable)
    if caller is not None and element.server_runnable is caller:
        yield f"{caller.name!r} calls itself as a server"


RULES = (
    ModelRule(
        id="TA-Software-RunnableCall",
        title="runnable that calls itself directly",
        severity=Severity.ERROR,
        target=RunnableCall,
        check=_check_call,
        rationale="The execution time of the runnable is unbounded. APP4MC's validation also reports it.",
        remedy="Remove the call, or call another runnable.",
        fails=runnable_with('<items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>'),
        edits={
            'runnable="R?type=Runnable"': 'runnable="Q?type=Runnable"',
            "</swModel>": """  <runnables name="Q"/>
</swModel>""",
        },
    ),
    ModelRule(
        id="TA-Software-ServerCall",
        title="server call of a runnable to itself",
        severity=Severity.ERROR,
        target=ServerCall,
        check=_check_server_call,
        rationale="A synchronous call waits for itself forever, and an asynchronous call is repeated forever. APP4MC's validation "
        "also reports it.",
        remedy="Remove the call, or call another runnable.",
        fails=runnable_with('<items xsi:type="am:SynchronousServerCall" serverRunnable="R?type=Runnable"/>'),
        edits={
            'serverRunnable="R?type=Runnable"': 'serverRunnable="Q?type=Runnable"',
            "</swModel>": """  <runnables name="Q"/>
</swModel>""",
        },
    ),
)
