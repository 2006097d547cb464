"""The synthetic older model of the benchmark is complete, and analysable."""

from older_models import itea_model, measured

from amalthea_uros import am, analyze_files, load


def test_everything_is_migrated(tmp_path):
    path = tmp_path / "old.amxmi"
    path.write_text(itea_model(runnables=20, accesses=5))
    model = load(path)
    assert [finding.rule for finding in model.findings] == ["XMI008"]
    assert (len(list(model.all(am.Runnable))), len(list(model.all(am.LabelAccess)))) == (20, 100)
    (task,) = model.all(am.Task)
    assert [call.runnable.name for call in task.activity_graph.items[0].items] == [f"R{number}" for number in range(20)]
    # There is no hardware in it, so that nothing is known of the time that it takes.
    (process,) = analyze_files(path).analysis.processes
    assert process.response is None or process.response.worst is None


def test_it_is_measured(tmp_path):
    path = tmp_path / "old.amxmi"
    path.write_text(itea_model(runnables=3, accesses=2))
    seconds, megabytes = measured(path, "load")
    assert seconds > 0
    assert megabytes > 10
