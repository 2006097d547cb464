"""ITEA 1.1.0 -> ITEA 1.2.0."""

import pytest
from itea import all_of, messages, model, only, write
from migration import migrated

TARGET = "ITEA 1.2.0"


def step(folder, **files):
    return migrated(write(folder, "1.1.0", **files), TARGET)


def test_schedulers_move_into_one_operating_system_where_the_first_was(tmp_path):
    models, notes = step(
        tmp_path,
        m__amxmi='<osModel><semaphores name="s"/><!-- the first --><scheduler name="a"/><scheduler name="b"/></osModel>',
    )
    os_model = only(models, "osModel")
    assert [child.tag for child in os_model.children] == ["semaphores", "operatingSystems"]
    assert [child.name for child in only(models, "osModel", "operatingSystems").all("taskSchedulers")] == ["a", "b"]
    assert only(models, "osModel", "operatingSystems").children[0].comments == ["<!-- the first -->"]
    assert len(messages(notes, "moved")) == 2


def test_schedulers_of_a_file_with_the_os_model_alone(tmp_path):
    models, _ = step(tmp_path, os__amxmi_os=model("1.1.0", '<scheduler name="a"/>', "os:OSModel"))
    assert only(models, "operatingSystems", "taskSchedulers").name == "a"


STATISTICS = '<read value="1"/><write value="2"/><readCacheMisses value="3"/><writeCacheMisses value="4"/>'


def accesses(kind, content, tag="runnableItems"):
    access = f'<{tag} xsi:type="sw:LabelAccess" {kind}><statistic>{content}</statistic></{tag}>'
    inside = access if tag == "runnableItems" else f'<runnableItems xsi:type="sw:Group"><items>{access}</items></runnableItems>'
    return f'<swModel><runnables name="R">{inside}</runnables></swModel>'


@pytest.mark.parametrize("tag", ["runnableItems", "runnableItem"])
@pytest.mark.parametrize(
    ("kind", "value", "misses"), [("", "1", "3"), ('access="read"', "1", "3"), ('access="write"', "2", "4")]
)
def test_the_statistic_that_fits_the_access_is_kept(tmp_path, kind, value, misses, tag):
    models, notes = step(tmp_path, m__amxmi=accesses(kind, STATISTICS, tag))
    [statistic] = all_of(models, "statistic")
    assert [(part.tag, part.get("value")) for part in statistic.children] == [("value", value), ("cacheMisses", misses)]
    assert len(messages(notes, "lost")) == 2


SOFTWARE = '<swModel><isrs xmi:id="_i1" name="I 1"/><isrs xmi:id="_i2" name="I2"/><tasks xmi:id="_t" name="T"/></swModel>'
SCHEDULERS = '<osModel><scheduler xmi:id="_s" name="S"/></osModel>'


def allocation(references, kind="ProcessAllocation"):
    return f'<executableAllocation xsi:type="mapping:{kind}" {references}/>'


def test_files_refer_to_each_other_by_position(tmp_path):
    models, _ = step(
        tmp_path,
        map__amxmi="""<mappingModel><executableAllocation xsi:type="mapping:ProcessAllocation">
            <scheduler href="os.amxmi-os#//@scheduler.0"/><process xsi:type="sw:ISR" href="sw.amxmi#//@swModel/@isrs.0"/>
            </executableAllocation></mappingModel>""",
        os__amxmi_os=model("1.1.0", '<scheduler name="S"/>', "os:OSModel"),
        sw__amxmi='<swModel><isrs name="I"/></swModel>',
    )
    [made] = all_of(models, "processAllocation")
    assert made.type == "mapping:ISRAllocation"
    assert made.target("scheduler").root.tag == "OSModel"
    assert made.target("process").name == "I"


def test_the_scheduler_of_an_isr_in_a_missing_file_is_lost(tmp_path):
    content = f"""{SOFTWARE}<mappingModel><executableAllocation xsi:type="mapping:ProcessAllocation" process="_i1">
        <scheduler href="os.amxmi#_s"/></executableAllocation></mappingModel>"""
    models, notes = step(tmp_path, m__amxmi=content)
    [made] = all_of(models, "processAllocation")
    assert (made.type, made.references.keys()) == ("mapping:ISRAllocation", {"process"})
    assert messages(notes, "lost") == ["scheduler of an ISR: not found in the files, and ISRs now have interrupt controllers"]


def test_the_interrupt_controller_of_an_early_file_stays(tmp_path):
    system = '<osModel><operatingSystems><interruptControllers xmi:id="_c" name="C"/></operatingSystems></osModel>'
    allocations = allocation('process="_i1" scheduler="_c"')
    models, notes = step(tmp_path, m__amxmi=f"{SOFTWARE}{system}<mappingModel>{allocations}</mappingModel>")
    [controller] = all_of(models, "interruptControllers")
    assert all_of(models, "processAllocation")[0].target("scheduler") is controller
    assert messages(notes, "lost") == []


def test_the_class_of_a_process_in_a_missing_file_is_that_of_the_reference(tmp_path):
    models, notes = step(
        tmp_path,
        m__amxmi=SCHEDULERS
        + """<mappingModel>
        <executableAllocation xsi:type="mapping:ProcessAllocation" scheduler="_s"><process xsi:type="sw:ISR" href="sw.amxmi#_x"/>
        </executableAllocation>
        <executableAllocation xsi:type="mapping:ProcessAllocation" scheduler="_s"><process href="sw.amxmi#_y"/>
        </executableAllocation></mappingModel>""",
    )
    assert [node.type for node in all_of(models, "processAllocation")] == ["mapping:ISRAllocation", "mapping:TaskAllocation"]
    assert messages(notes, "defaulted") == ["allocation of a process that is not in the files; assuming a task"]


@pytest.mark.parametrize(
    ("references", "kind"),
    [
        ('process="_i1"', "ISRAllocation"),
        ('process="_t"', "TaskAllocation"),
        ('scheduler="_s"', "TaskAllocation"),
        ("", "TaskAllocation"),
    ],
)
def test_incomplete_allocations(tmp_path, references, kind):
    content = f"{SOFTWARE}{SCHEDULERS}<mappingModel>{allocation(references)}</mappingModel>"
    models, _ = step(tmp_path, m__amxmi=content)
    assert [node.type for node in all_of(models, "processAllocation")] == [f"mapping:{kind}"]
