from importlib import import_module

import pytest
from lxml import etree
from synthetic import synthetic_folder, synthetic_model

pytest.importorskip("pyecore")
pyecore_reader = import_module("pyecore_reader")


@pytest.fixture
def model_file(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(synthetic_model(1500), encoding="utf-8")
    return path


def tree(element: etree._Element) -> tuple:
    """An element with numbers as numbers and without the order of features."""
    values = {name: float(value) if name == "pRemainPromille" else value for name, value in element.attrib.items()}
    return element.tag, values, [tree(child) for child in sorted(element, key=lambda child: child.tag)]


def test_loads_with_resolved_references(model_file):
    root = pyecore_reader.load(model_file).contents[0]
    (allocation, *_) = root.mappingModel.taskAllocation
    assert allocation.task is root.swModel.tasks[0]
    assert allocation.task.stimuli[0].name == "Stimulus_0"


def test_saves_what_it_loaded(model_file, tmp_path):
    saved = tmp_path / "saved.amxmi"
    pyecore_reader.save(pyecore_reader.load(model_file), saved)
    assert tree(etree.parse(saved).getroot()) == tree(etree.parse(model_file).getroot())


def test_resolves_across_files(tmp_path):
    paths = [tmp_path / name for name in synthetic_folder(3000)]
    for path, text in zip(paths, synthetic_folder(3000).values(), strict=True):
        path.write_text(text, encoding="utf-8")
    _, first, *_ = pyecore_reader.load_all(paths)
    (allocation, *_) = first.contents[0].mappingModel.taskAllocation
    assert allocation.scheduler.name == "OSEK on Core 0.0"


def test_refuses_versions_without_ids():
    with pytest.raises(ValueError, match=r"0\.7\.2"):
        pyecore_reader.metamodel("0.7.2")
