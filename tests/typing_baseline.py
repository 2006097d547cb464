"""What users may rely on, checked by mypy alone (see test_typing.py)."""

from collections.abc import Mapping

import amalthea_uros as amuros
from amalthea_uros.am import Preemption, Runnable, Task, Time
from amalthea_uros.timing.basics.time_base import max_time, min_time
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.units import MILLISECOND

model: amuros.Model = amuros.load("model.amxmi")
found: Task | None = model.find(Task, "Executor_Task")
task: Task = model[Task, "Executor_Task"]
names: list[str | None] = [runnable.name for runnable in model.all(Runnable)]
made = Task(name="t", preemption=Preemption.PREEMPTIVE)
time = Time(10, "ms")
value: int | None = time.value
stimuli: list[amuros.am.Stimulus] = task.stimuli
graph: amuros.am.ActivityGraph | None = task.activity_graph
amuros.save(model, "model.amxmi")
migrated: amuros.Model = amuros.migrate("old.amxmi", to="3.0.0").model

analysis: amuros.Analysis = amuros.analyze({"amuros": 1})
changed: amuros.Analysis = amuros.what_if(model, {"Executor_Task.period": "2 ms"}).after
process: amuros.ProcessResult = analysis["Executor_Task"]
system: amuros.System = amuros.taskset([amuros.task("T", period="5 ms", wcet="1 ms"), ("5 ms", 1.5)], policy="EDF")
rows: list[dict[str, str | int | float | bool | None]] = analysis.chains.to_records()
small: list[dict[str, str | int | float | bool | None]] = amuros.explain(system, "T").to_records()
best: amuros.Improvements = amuros.improvements(analysis, "chain")
listed: amuros.System = amuros.taskset([{"period": 5, "wcet": 1}, (10, 2, 8)], unit="ms")
new: Task = amuros.Model.new().add_task("T", period="5 ms", wcet="1 ms", priority=1)

hops: tuple[amuros.Hop, ...] = analysis.chains["command"].hops
handle: amuros.HandleResult = analysis.executors["Executor"].handles["drive"]
texts: Mapping[str, str] = amuros.generate("app.yaml").texts
fine: bool = amuros.check_colcon_meta("app.yaml", "colcon.meta").is_fine
description: str = amuros.import_code("src/main.c").text
profile: amuros.Profile = amuros.describe("app.yaml").profile

Task(name=3)  # type: ignore[arg-type]
Task(nme="t")  # type: ignore[call-arg]
task.preemption = "preemptive"  # type: ignore[assignment]
task.activity_graph = Runnable()  # type: ignore[assignment]
task.prority = 1  # type: ignore[attr-defined]

# A time is no demand, whose unit depends on the core.
MultiframeDemand.constant(MILLISECOND)  # type: ignore[arg-type]
max_time(MILLISECOND, 3)  # type: ignore[arg-type]
min_time(MILLISECOND, 3)  # type: ignore[arg-type]
