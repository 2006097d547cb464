"""Runs of small hand-made systems, in microseconds, to be compared with schedules derived by hand."""

from dataclasses import dataclass, replace

from hand_made_systems import system
from opponent.simulation import Recording, record

from amalthea_uros.perf.conditions import Condition
from amalthea_uros.simulate.options import Options
from amalthea_uros.timing.observed.job_times import JobColumn
from amalthea_uros.trace.table import EventKind
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration


def built(*processes, modes=(), mode_labels=(), channels=(), stimuli=(), **parts):
    """A system as `hand_made_systems.system` makes it, with further software and stimuli."""
    found = system(*processes, **parts)
    return replace(
        found,
        software=replace(found.software, modes=modes, mode_labels=mode_labels, channels=channels),
        stimuli=replace(found.stimuli, stimuli=(*found.stimuli.stimuli, *stimuli)),
    )


def when(*comparisons):
    """A condition that holds if all comparisons do."""
    return Condition((comparisons,))


@dataclass(frozen=True)
class Played:
    """A run of a system, in which all processes could be simulated."""

    recording: Recording

    def __getitem__(self, process):
        """Activation, start and end of the jobs of a process."""
        return [tuple(time // US for time in job) for job in self.recording.jobs_of(process)]

    def column(self, process, column):
        """A column of the rows of the jobs of a process."""
        number = self.recording.program.processes.index(process)
        return [row[column] for row in self.recording.jobs if row[JobColumn.PROCESS] == number]

    def times(self, process, column):
        """The same in microseconds."""
        return [time // (US * self.recording.program.units) for time in self.column(process, column)]

    def events(self, process, *kinds):
        """The times and the kinds of events of a process, the core or stimulus that causes them, and the number of the job."""
        program = self.recording.program
        return [
            (time // (US * program.units), EventKind(kind), program.entities[source].name, instance)
            for time, kind, source, _, target, instance, _ in self.recording.events
            if kind in kinds and program.entities[target].name == process
        ]


def play(model, until, traced=False):
    """Play a system; all its processes must be simulated."""
    found = record(model, Options(duration=Duration(until * US), traced=(0, Duration(until * US)) if traced else None))
    assert found.program.left_out == {}
    return Played(found)


def allocated(model, **changes):
    """A system in which some tasks are allocated differently: fields of the allocation by the name of the task."""
    tasks = (replace(each, **changes.get(each.task, {})) for each in model.mapping.tasks)
    return replace(model, mapping=replace(model.mapping, tasks=tuple(tasks)))
