"""perf -> amxmi -> perf is the identity."""

from itertools import product

import pytest
from effort import every, examples
from hypothesis import given
from hypothesis import strategies as st
from support import MODEL, ROOT, corpus, hand_written
from system_strategies import systems

from amalthea_uros import describe
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.cli.descriptions import VERSIONS
from amalthea_uros.errors import WriteError
from amalthea_uros.perf.os import Os, Semaphore, SemaphoreKind
from amalthea_uros.perf.system import System
from amalthea_uros.xmi.load import load
from amalthea_uros.xmi.save import save
from amalthea_uros.xmi.schema import validate

SAMPLES = sorted((ROOT / "samples").glob("*.yaml"))
WITH_DEADLINES = ROOT / "samples" / "drive-and-lift.yaml"


def there_and_back(system, path, version=None):
    save(build_model(system, version), path)
    extraction = extract(load(path))
    # Bounds without a distribution are written as one that misses its parameters.
    unshaped = "GaussDistribution is incomplete: it has no mean"
    assert [finding for finding in extraction.findings if not finding.message.endswith(unshaped)] == []
    return extraction.system


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return tmp_path_factory.mktemp("identity") / "system.amxmi"


@given(system=systems())
@examples(12)
def test_every_system_comes_back(file, system):
    assert there_and_back(system, file) == system
    assert validate(file.read_bytes(), "3.3.0") == []


@given(system=systems(most=1), version=st.sampled_from(VERSIONS))
@examples(12)
def test_a_system_comes_back_from_an_older_version_or_is_refused_by_name(file, system, version):
    file.unlink(missing_ok=True)
    try:
        found = there_and_back(system, file, version)
    except WriteError as error:
        findings = error.findings
    else:
        assert found == system
        return
    assert version not in ("3.0.0", "3.1.0", "3.2.0", "3.3.0")
    assert all(finding.object for finding in findings)
    assert not file.exists()


def test_a_sample_with_what_a_version_lacks():
    with pytest.raises(WriteError, match=r"Task_Log: AMALTHEA 1\.2\.0 cannot represent the scheduling parameter 'deadline'"):
        build_model(describe(WITH_DEADLINES).system, "1.2.0")


@pytest.mark.parametrize(
    ("sample", "version"),
    every(5, [case for case in product(SAMPLES, VERSIONS) if case != (WITH_DEADLINES, "1.2.0")]),
    ids=lambda value: getattr(value, "stem", value),
)
def test_a_sample_comes_back_from_every_version(sample, version, file):
    system = describe(sample).system
    assert there_and_back(system, file, version) == system
    assert validate(file.read_bytes(), version) == []


@pytest.mark.parametrize("path", corpus())
def test_what_is_extracted_from_a_published_model_comes_back(path, file):
    system = extract(load(path)).system
    assert there_and_back(system, file) == system


@pytest.mark.parametrize("path", hand_written())
def test_what_is_extracted_from_a_defective_model_comes_back(path, file):
    from amalthea_uros.errors import ReadError

    try:
        model = load(path)
    except ReadError:
        return
    system = extract(model).system
    assert there_and_back(system, file) == system


def test_default_values_of_parameters_count(tmp_path):
    path = tmp_path / "model.amxmi"
    excerpt = """
<swModel><tasks name="T"/><tasks name="U"/></swModel>
<osModel>
  <operatingSystems name="OS"><taskSchedulers name="S" definition="FPP?type=SchedulerDefinition"/></operatingSystems>
  <schedulerDefinitions name="FPP" processParameters="priority?type=SchedulingParameterDefinition"/>
  <schedulingParameterDefinitions name="priority" type="Integer">
    <defaultValue xsi:type="am:IntegerObject" value="7"/>
  </schedulingParameterDefinitions>
</osModel>
<mappingModel>
  <taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"/>
  <taskAllocation task="U?type=Task" scheduler="S?type=TaskScheduler">
    <schedulingParameters key="priority?type=SchedulingParameterDefinition">
      <value xsi:type="am:IntegerObject" value="1"/>
    </schedulingParameters>
  </taskAllocation>
</mappingModel>
"""
    path.write_text(MODEL.format(excerpt))
    allocations = extract(load(path)).system.mapping.tasks
    assert {allocation.task: allocation.priority for allocation in allocations} == {"T": 7, "U": 1}


@pytest.mark.parametrize("version", ["2.2.0", "3.3.0"])
@pytest.mark.parametrize("kind", [SemaphoreKind.COUNTING, SemaphoreKind.RESOURCE, SemaphoreKind.SPINLOCK])
@pytest.mark.parametrize("ownership", [True, False])
def test_who_may_release_a_semaphore_comes_back(file, version, kind, ownership):
    """Before 3.0.0 only the type of a semaphore says it."""
    system = System(os=Os(semaphores=(Semaphore(name="L", kind=kind, ownership=ownership),)))
    assert there_and_back(system, file, version).os.semaphores == system.os.semaphores
