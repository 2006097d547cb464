"""Projects against those that INCHRON's importer makes of the same AMALTHEA models, fact by fact."""

import json
import re

import pytest
from iprx_facts import VECTORS, differences, facts_of

from amalthea_uros.services.export import export

#: What the importer leaves out: patterns of facts that only we write, each with the reason.
ADDED = {
    r"/comment$": "a project has no place for it",
    r"/(memories|interconnects)\[\w+\]/clock$": "the metamodel demands a clock",
    r"^/requirements(\[\w+_response_time\])?$": "the importer drops requirements on processes and runnables",
    r"/generators\[rounds_of_\w+\]$": "the importer drops the activations of executors",
    r"/graphEntries\[CallSequence_0\]/calls\[ModeAccess\]$": "the importer drops reads of modes",
}
#: Where the importer writes something that the model does not say: by the model, the reason and the pattern of the facts that differ.
CHANGED = {
    "10_chain_gap": ("it drops the end of a part where the next one begins with another event", r"^/eventChains\[EC\]/nodes"),
    "10_lat_nobounds": ("a latency constraint without bounds becomes an upper limit of 0", r"^/requirements\[LC\]/"),
    "20_ticks_beta": ("a beta distribution becomes its upper bound", r"/timeDistribution/type$"),
    "20_ticks_bounds_default": ("the mean of two bounds is less than both", r"/timeDistribution/mean/value$"),
    "22_label_undef": ("an access of unknown kind becomes a read", r"/variables$|/calls\[(Incomplete|LabelAccess_L1_0)\]$"),
    "25_modelabelaccess": ("a mode is set to the step instead of the value", r"/calls\[NumericModeLabelAccess_1\]/value$"),
    "25_switch_num_lt": ("every relation becomes an equality", r"^/globalConditions\[Condition_0\]/conjunctions"),
    "44_unalloc_task_only": ("a task without allocation disappears", r"^/systems\[__GLOBAL__\]$|/calls\[ActivateT1\]/target$"),
}


def vectors():
    found = sorted(VECTORS.glob("*.json"))
    return [pytest.param(path, id=path.stem) for path in found] or [pytest.param(None, marks=pytest.mark.skip("no vectors"))]


@pytest.mark.parametrize("vector", vectors())
def test_projects_are_those_of_the_importer(vector, tmp_path):
    stored = json.loads(vector.read_text())
    result = export(VECTORS / stored["input"], tmp_path / "project.iprx")
    changed = [
        path
        for path, _, theirs in differences(facts_of(result.text), stored["model"])
        if theirs is not None or not any(re.search(pattern, path) for pattern in ADDED)
    ]
    _, pattern = CHANGED.get(vector.stem, ("", None))
    assert [path for path in changed if pattern is None or not re.search(pattern, path)] == []
    assert bool(changed) == (pattern is not None)
