"""What a model says of how often something is called or accessed is used, or reported as not used."""

import pytest
from support import MODEL

from amalthea_uros import extract, load
from amalthea_uros.perf.activities import Count

CALL = '<items xsi:type="am:RunnableCall" runnable="R?type=Runnable">{}</items>'
OF_CALL = "<statistic>{}</statistic>"


def extracted(item, folder):
    path = folder / "model.amxmi"
    graph = f'<tasks name="T"><activityGraph>{item}</activityGraph></tasks>'
    path.write_text(MODEL.format(f'<swModel>{graph}<runnables name="R"/><labels name="L"/></swModel>'))
    found = extract(load(path))
    (activity,) = found.system.software.tasks[0].activities
    return activity, [finding for finding in found.findings if finding.rule in ("EXT001", "EXT004")]


@pytest.mark.parametrize(
    ("statistic", "times"),
    [
        ('<statistic xsi:type="am:SingleValueStatistic" value="3.0"/>', 3.0),
        ('<statistic xsi:type="am:SingleValueStatistic" value="2.5"/>', 2.5),
        ('<statistic xsi:type="am:MinAvgMaxStatistic" min="1" avg="1.5" max="2"/>', Count(least=1, mean=1.5, most=2)),
        # EMF does not write zeros.
        ('<statistic xsi:type="am:MinAvgMaxStatistic" max="2"/>', Count(least=0, mean=0.0, most=2)),
    ],
)
def test_a_number_of_calls(statistic, times, tmp_path):
    call, findings = extracted(CALL.format(OF_CALL.format(statistic)), tmp_path)
    assert (call.times, findings) == (times, [])


@pytest.mark.parametrize("kind", ["SingleValueStatistic", "MinAvgMaxStatistic"])
def test_a_statistic_without_values_is_no_zero(kind, tmp_path):
    call, (finding,) = extracted(CALL.format(OF_CALL.format(f'<statistic xsi:type="am:{kind}"/>')), tmp_path)
    assert (call.times, finding.rule) == (None, "EXT004")


def test_cache_misses_are_reported_as_not_used(tmp_path):
    missed = '<statistic><cacheMisses xsi:type="am:SingleValueStatistic" value="3.0"/></statistic>'
    item = f'<items xsi:type="am:LabelAccess" data="L?type=Label" access="read">{missed}</items>'
    access, (finding,) = extracted(item, tmp_path)
    assert (access.times, finding.rule) == (None, "EXT001")
    assert "LabelAccessStatistic.cacheMisses" in finding.message
