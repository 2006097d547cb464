"""Rules of a project, for `amuros check --rules naming_rules.py`: an example of how to make some."""

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Task
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(task: Task, context: Context) -> Iterator[str]:
    if not (task.name or "").endswith("_Task"):
        yield f"the name of the task {task.name!r} does not end with '_Task'"


RULE = ModelRule(
    id="ACME-TASK-NAME",
    title="task whose name does not end with _Task",
    severity=Severity.WARNING,
    target=Task,
    check=_check,
    rationale="The code generator of ACME finds tasks by this ending.",
    remedy="Rename the task.",
    fails='<swModel><tasks name="Control"/></swModel>',
    passes='<swModel><tasks name="Control_Task"/></swModel>',
)
