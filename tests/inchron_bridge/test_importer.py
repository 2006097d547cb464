"""Projects against those that INCHRON's importer makes of the same AMALTHEA models, fact by fact."""

import json
import re

import pytest
from iprx_facts import VECTORS, differences, facts_of

from amalthea_uros.services.export import export

#: Where another result is intended: paths of facts, with the reason. What the importer drops is in none of its projects.
INTENDED = {
    r"/comment$": "keeps what a project has no place for",
    r"/memories\[.*\]/clock$|/interconnects\[CH0\]/clock$": "the metamodel demands a clock, which the importer leaves out",
    r"^/requirements(\[\w+_response_time\])?$": "the importer drops requirements on processes and runnables",
    r"/generators\[rounds_of_\w+\]$": "the importer drops the activations of executors",
    r"/graphEntries\[CallSequence_0\]/calls\[ModeAccess\]$": "the importer drops reads of modes",
}
#: The same in single models, where the importer writes something that the model does not say.
INTENDED_IN = {
    "10_chain_gap": r"^/eventChains\[EC\]/nodes",  # the end of a part is dropped where the next one begins with another event
    "10_lat_nobounds": r"^/requirements\[LC\]/",  # a latency constraint without bounds becomes an upper limit of 0
    "20_ticks_beta": r"/timeDistribution/type$",  # a beta distribution becomes its upper bound
    "20_ticks_bounds_default": r"/timeDistribution/mean/value$",  # the mean of two bounds is less than both
    "22_label_undef": r"/variables$|/calls\[(Incomplete|LabelAccess_L1_0)\]$",  # an access of unknown kind becomes a read
    "25_modelabelaccess": r"/calls\[NumericModeLabelAccess_1\]/value$",  # a mode is set to the step instead of the value
    "25_switch_num_lt": r"^/globalConditions\[Condition_0\]/conjunctions",  # every relation becomes an equality
    "44_unalloc_task_only": r"^/systems\[__GLOBAL__\]$|/calls\[ActivateT1\]/target$",  # a task without allocation disappears
}


def vectors():
    found = sorted(VECTORS.glob("*.json"))
    return [pytest.param(path, id=path.stem) for path in found] or [pytest.param(None, marks=pytest.mark.skip("no vectors"))]


@pytest.mark.parametrize("vector", vectors())
def test_projects_are_those_of_the_importer(vector, tmp_path):
    stored = json.loads(vector.read_text())
    result = export(VECTORS / stored["input"], tmp_path / "project.iprx")
    found = [path for path, *_ in differences(facts_of(result.text), stored["model"])]
    other = [path for path in found if not any(re.search(pattern, path) for pattern in INTENDED)]
    intended = INTENDED_IN.get(vector.stem)
    assert [path for path in other if intended is None or not re.search(intended, path)] == []
    assert bool(other) == (intended is not None)
