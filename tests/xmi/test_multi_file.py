"""Models of several files: references lead from file to file by name, whatever the files are called."""

import pytest
from support import meaning

import amalthea_uros as amuros
from amalthea_uros import Document
from amalthea_uros.am import (
    Amalthea,
    Component,
    ComponentPort,
    EnumMode,
    HwConnection,
    HwPort,
    HwStructure,
    Label,
    MappingModel,
    MemoryMapping,
    ModeLiteral,
    Namespace,
    Runnable,
    RunnableCall,
    Task,
    TaskAllocation,
)

ROOT = '<am:Amalthea xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:am="http://app4mc.eclipse.org/amalthea/3.3.0">'
SOFTWARE = f"""<?xml version="1.0" encoding="UTF-8"?>
{ROOT}
  <swModel>
    <tasks xmi:id="T?type=Task" name="T" multipleTaskActivationLimit="0">
      <activityGraph>
        <items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>
      </activityGraph>
    </tasks>
    <runnables xmi:id="R?type=Runnable" name="R" callback="false" service="false"/>
    <labels xmi:id="L?type=Label" name="L" constant="false" bVolatile="false"/>
  </swModel>
</am:Amalthea>
"""
MAPPING = f"""<?xml version="1.0" encoding="UTF-8"?>
{ROOT}
  <mappingModel>
    <taskAllocation>
      <task href="amlt:/#T?type=Task"/>
      <scheduler href="amlt:/#Elsewhere?type=TaskScheduler"/>
    </taskAllocation>
    <memoryMapping memoryPositionAddress="0x10">
      <abstractElement xsi:type="am:Label" href="amlt:/#L%3Ftype%3DLabel"/>
    </memoryMapping>
  </mappingModel>
</am:Amalthea>
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "sw.amxmi").write_text(SOFTWARE)
    (tmp_path / "mapping.amxmi").write_text(MAPPING)
    return tmp_path


def texts(folder):
    return (folder / "sw.amxmi").read_text(), (folder / "mapping.amxmi").read_text()


def test_references_lead_to_the_other_file(folder):
    model = amuros.load(folder)
    assert next(model.all(TaskAllocation)).task is model[Task, "T"]
    assert next(model.all(MemoryMapping)).abstract_element is model[Label, "L"]


def test_order_and_naming_of_the_files_do_not_matter(folder):
    (folder / "sw.amxmi").rename(folder / "a.amxmi")
    for model in (
        amuros.load(folder / "mapping.amxmi", folder / "a.amxmi"),
        amuros.load([str(folder / "a.amxmi"), folder / "mapping.amxmi"]),
    ):
        assert next(model.all(TaskAllocation)).task is model[Task, "T"]


def test_what_is_odd_is_told(folder):
    rules = {(f.rule, f.location.path.name, f.location.line) for f in amuros.load(folder).findings}
    assert rules == {("XMI024", "mapping.amxmi", 8), ("XMI025", "mapping.amxmi", 4)}


def test_an_unchanged_model_is_written_to_the_letter(folder):
    amuros.save(amuros.load(folder))
    assert texts(folder) == (SOFTWARE, MAPPING)


def test_a_rename_reaches_the_sibling_file_and_nothing_else(folder):
    model = amuros.load(folder)
    model[Task, "T"].name = "T 2"
    amuros.save(model)
    assert texts(folder) == (
        SOFTWARE.replace('"T?type=Task" name="T"', '"T+2?type=Task" name="T 2"'),
        MAPPING.replace("#T?type=Task", "#T+2?type=Task"),
    )


def test_a_reference_encoded_twice_is_kept_until_its_target_is_renamed(folder):
    model = amuros.load(folder)
    model[Label, "L"].name = "M"
    amuros.save(model)
    assert texts(folder)[1] == MAPPING.replace("#L%3Ftype%3DLabel", "#M?type=Label")


def test_saved_elsewhere_the_files_keep_their_names(folder, tmp_path):
    amuros.save(amuros.load(folder), tmp_path / "copy")
    assert texts(tmp_path / "copy") == (SOFTWARE, MAPPING)


def test_documents_of_the_same_name_do_not_become_one(tmp_path):
    paths = [tmp_path / name / "a.amxmi" for name in ("one", "other")]
    for path in paths:
        path.parent.mkdir()
        path.write_text(SOFTWARE)
    with pytest.raises(amuros.WriteError, match=r"XMI101.*two documents would be written here"):
        amuros.save(amuros.load(*paths), tmp_path / "both")
    assert not list((tmp_path / "both").iterdir())


def test_an_object_moved_to_another_file_is_referred_to_by_href(folder):
    model = amuros.load(folder)
    mapping = next(d.root for d in model.documents if d.root.mapping_model)
    mapping.sw_model = amuros.am.SWModel(runnables=[model[Runnable, "R"]])
    amuros.save(model)
    software, mapped = texts(folder)
    assert '<runnable href="amlt:/#R?type=Runnable"/>' in software
    assert '<runnables xmi:id="R?type=Runnable" name="R"' in mapped
    again = amuros.load(folder)
    assert meaning(again) == meaning(model)


def test_and_back(folder):
    model = amuros.load(folder)
    software = next(d.root for d in model.documents if d.root.sw_model)
    software.mapping_model = MappingModel(task_allocation=[TaskAllocation(task=model[Task, "T"])])
    amuros.save(model)
    assert '<taskAllocation task="T?type=Task"/>' in texts(folder)[0]


def test_a_reference_by_href_within_one_file_stays_one(tmp_path):
    path = tmp_path / "one.amxmi"
    text = SOFTWARE.replace(
        '<items xsi:type="am:RunnableCall" runnable="R?type=Runnable"/>',
        '<items xsi:type="am:RunnableCall">\n          <runnable href="amlt:/#R?type=Runnable"/>\n        </items>',
    )
    path.write_text(text)
    model = amuros.load(path)
    assert next(model.all(RunnableCall)).runnable is model[Runnable, "R"]
    amuros.save(model, canonical=True)
    assert path.read_text() == text
    model[Runnable, "R"].name = "Q"
    amuros.save(model)
    assert '<runnable href="amlt:/#Q?type=Runnable"/>' in path.read_text()


ID = "_Zp_LgNotEeWXsaNW2kxe8A"


def test_an_id_in_another_file_keeps_the_class_that_is_stated(tmp_path):
    # The declared class is AbstractProcess, which an element cannot have.
    processes = f'<processes xsi:type="am:Task" href="amlt:/#{ID}"/>'
    path = tmp_path / "one.amxmi"
    component = f'<componentsModel>\n    <components name="C">\n      {processes}\n    </components>\n  </componentsModel>'
    path.write_text(f'<?xml version="1.0" encoding="UTF-8"?>\n{ROOT}\n  {component}\n</am:Amalthea>\n')
    amuros.save(amuros.load(path), canonical=True)
    assert processes in path.read_text()


def test_a_migration_keeps_the_class_of_an_id_in_another_file(tmp_path):
    path = tmp_path / "old.amxmi"
    spaces = " ".join(
        f'xmlns:{name}="http://www.amalthea.itea2.org/model/1.2.0/{name}"' for name in ("central", "components", "sw")
    )
    path.write_text(
        f"""<?xml version="1.0" encoding="UTF-8"?>
<central:AMALTHEA xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" {spaces}>
  <componentsModel>
    <elements xsi:type="components:Component" name="C"><tasks xsi:type="sw:Task" href="other.amxmi#{ID}"/></elements>
  </componentsModel>
</central:AMALTHEA>
"""
    )
    result = amuros.migrate(path)
    result.save(tmp_path / "new.amxmi")
    assert f'<processes xsi:type="am:Task" href="amlt:/#{ID}"/>' in (tmp_path / "new.amxmi").read_text()


def test_an_object_in_two_files_is_told_and_the_nearer_one_is_meant(folder):
    (folder / "other.amxmi").write_text(SOFTWARE)
    model = amuros.load(folder)
    for document in model.documents:
        for call in document.root.walk():
            if isinstance(call, RunnableCall):
                assert call.runnable.document is document
    assert "XMI021" in {finding.rule for finding in model.findings}


def test_a_removed_object_that_is_still_referred_to_is_not_written(folder):
    model = amuros.load(folder)
    task = model[Task, "T"]
    task.container.tasks.remove(task)
    with pytest.raises(amuros.WriteError, match=r"'T'.*not part of the model"):
        amuros.save(model)
    assert texts(folder) == (SOFTWARE, MAPPING)


@pytest.fixture
def prefixed(tmp_path):
    """Objects whose names are made from those of others, in one file; references to them in another."""
    port, literal, component_port = HwPort(name="p 1"), ModeLiteral(name="on"), ComponentPort(name="in")
    space = Namespace(name="com", next_segments=[Namespace(name="x/y")])
    member = Runnable(name="run", namespace=space.next_segments[0])
    parts = Amalthea(
        common_elements=amuros.am.CommonElements(namespaces=[space]),
        hw_model=amuros.am.HWModel(structures=[HwStructure(name="Board", ports=[port])]),
        sw_model=amuros.am.SWModel(modes=[EnumMode(name="Mode", literals=[literal])], runnables=[member]),
        components_model=amuros.am.ComponentsModel(components=[Component(name="C", ports=[component_port])]),
    )
    users = Amalthea(
        hw_model=amuros.am.HWModel(structures=[HwStructure(name="Net", connections=[HwConnection(name="c", port1=port)])]),
        sw_model=amuros.am.SWModel(
            tasks=[Task(name="T", activity_graph=amuros.am.ActivityGraph(items=[RunnableCall(runnable=member)]))]
        ),
        components_model=amuros.am.ComponentsModel(
            systems=[
                amuros.am.System(
                    name="S",
                    connectors=[amuros.am.Connector(source_port=amuros.am.QualifiedPort(port=component_port))],
                )
            ]
        ),
    )
    documents = [Document(parts, path=tmp_path / "parts.amxmi"), Document(users, path=tmp_path / "users.amxmi")]
    amuros.save(amuros.Model(documents))
    return tmp_path


@pytest.mark.parametrize(
    ("cls", "name", "new", "href"),
    [
        (HwStructure, "Board", "E/E Board", "E%2FE+Board/p+1?type=HwPort"),
        (HwPort, "p 1", "p2", "Board/p2?type=HwPort"),
        (Component, "C", "D", "D/in?type=ComponentPort"),
        (Namespace, "com", "org", "org/x%2Fy/run?type=Runnable"),
        (Namespace, "x/y", "z", "com/z/run?type=Runnable"),
    ],
)
def test_a_rename_reaches_the_parts_whose_names_it_is_in(cls, name, new, href, prefixed):
    model = amuros.load(prefixed)
    assert model.findings == ()
    model[cls, name].name = new
    amuros.save(model)
    assert f'href="amlt:/#{href}"' in (prefixed / "users.amxmi").read_text()
    again = amuros.load(prefixed)
    assert again.findings == ()
    assert meaning(again) == meaning(model)
