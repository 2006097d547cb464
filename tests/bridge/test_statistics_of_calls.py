"""What a model says of how often something is called or accessed, and of allocations, is used, or reported as not used."""

import pytest
from support import model_text

from amalthea_uros import extract, load
from amalthea_uros.perf.activities import Count

CALL = '<items t="RunnableCall" runnable="R?type=Runnable">{}</items>'
OF_CALL = "<statistic>{}</statistic>"


def extracted(item, folder):
    path = folder / "model.amxmi"
    graph = f'<tasks name="T"><activityGraph>{item}</activityGraph></tasks>'
    path.write_text(model_text(f'<swModel>{graph}<runnables name="R"/><labels name="L"/></swModel>'))
    found = extract(load(path))
    (activity,) = found.system.software.tasks[0].activities
    return activity, [finding for finding in found.findings if finding.rule in ("EXT001", "EXT004")]


@pytest.mark.parametrize(
    ("statistic", "times"),
    [
        ('<statistic t="SingleValueStatistic" value="3.0"/>', 3.0),
        ('<statistic t="SingleValueStatistic" value="2.5"/>', 2.5),
        ('<statistic t="MinAvgMaxStatistic" min="1" avg="1.5" max="2"/>', Count(least=1, mean=1.5, most=2)),
        # EMF does not write zeros.
        ('<statistic t="MinAvgMaxStatistic" max="2"/>', Count(least=0, mean=0.0, most=2)),
    ],
)
def test_a_number_of_calls(statistic, times, tmp_path):
    call, findings = extracted(CALL.format(OF_CALL.format(statistic)), tmp_path)
    assert (call.times, findings) == (times, [])


@pytest.mark.parametrize("kind", ["SingleValueStatistic", "MinAvgMaxStatistic"])
def test_a_statistic_without_values_is_no_zero(kind, tmp_path):
    call, (finding,) = extracted(CALL.format(OF_CALL.format(f'<statistic t="{kind}"/>')), tmp_path)
    assert (call.times, finding.rule) == (None, "EXT004")


def test_cache_misses_are_reported_as_not_used(tmp_path):
    missed = '<statistic><cacheMisses t="SingleValueStatistic" value="3.0"/></statistic>'
    item = f'<items t="LabelAccess" data="L?type=Label" access="read">{missed}</items>'
    access, (finding,) = extracted(item, tmp_path)
    assert (access.times, finding.rule) == (None, "EXT001")
    assert "LabelAccessStatistic.cacheMisses" in finding.message


def test_allocations_that_are_not_used_are_reported(tmp_path):
    path = tmp_path / "model.amxmi"
    allocations = (
        '<taskAllocation task="T?type=Task" scheduler="S?type=TaskScheduler"><schedulingParameters/></taskAllocation>'
        '<memoryMapping abstractElement="R?type=Runnable"/><runnableAllocation entity="R?type=Runnable"/>'
    )
    system = '<osModel><operatingSystems name="OS"><taskSchedulers name="S"/></operatingSystems></osModel>'
    software = '<swModel><tasks name="T"/><runnables name="R"/></swModel>'
    path.write_text(model_text(f"{software}{system}<mappingModel>{allocations}</mappingModel>"))
    messages = [finding.message for finding in extract(load(path)).findings if finding.rule in ("EXT001", "EXT004")]
    assert sorted(messages) == [
        "1 object of class MemoryMapping is not used by the analysis",
        "1 object of class RunnableAllocation is not used by the analysis",
        "SchedulingParameter ignored: it has no key or no value",
    ]
