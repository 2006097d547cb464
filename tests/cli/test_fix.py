"""`amuros check --fix`: what is repaired, and what is not."""

from collections import Counter

import pytest
from command import amuros
from support import DATA, MODEL, ROOT, meaning

from amalthea_uros import load
from amalthea_uros.services.check import check_files
from amalthea_uros.services.fix import fix_files
from amalthea_uros.validate import registry
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelCheck

RELATIVE = """
<stimuliModel>
  <stimuli xsi:type="am:RelativePeriodicStimulus" name="S">
    <nextOccurrence xsi:type="am:TimeUniformDistribution">
      <lowerBound value="{}" unit="{}"/>
      <upperBound value="{}" unit="{}"/>
    </nextOccurrence>
  </stimuli>
</stimuliModel>
"""


def property_of_task(*values):
    entries = "".join(
        f'<customProperties key="k"><value xsi:type="am:StringObject" value="{v}"/></customProperties>' for v in values
    )
    return f'<swModel><tasks name="T">{entries}</tasks></swModel>'


CASES = [
    ("INC-ST-RELPER-UNIT", RELATIVE.format(10, "ms", 100, "us"), RELATIVE.format(10000, "us", 100, "us")),
    ("AM-EMF-INTRINSIC/map-entry-unique", property_of_task(1, 1, 1), property_of_task(1)),
    (
        "AM-EMF-INTRINSIC/IReferable.name",
        '<swModel><tasks/><tasks name="Task_1"/></swModel>',
        '<swModel><tasks name="Task_2"/><tasks name="Task_1"/></swModel>',
    ),
    (
        "AM-EMF-INTRINSIC/unique-id",
        '<swModel><tasks name="T"/><isrs name="T"/><tasks name="T"/></swModel>',
        '<swModel><tasks name="T"/><isrs name="T"/><tasks name="T_1"/></swModel>',
    ),
]


@pytest.mark.parametrize(("rule", "before", "after"), CASES, ids=[case[0] for case in CASES])
def test_a_repair_changes_only_what_is_wrong(rule, before, after, tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(MODEL.format(before))
    run = amuros("check", "--fix", "--select", rule, path)
    assert (run.returncode, run.stdout) == (0, "no findings\n")
    assert f"{rule} repaired in 1 object\n" in run.stderr
    assert path.read_text() == MODEL.format(after)


AMBIGUOUS = [
    # Which of two values counts, and what stands without a unit, nobody but the author knows.
    ("AM-EMF-INTRINSIC/map-entry-unique", property_of_task(1, 2)),
    ("INC-ST-UNIT", '<swModel><labels name="L"><size value="4"/></labels></swModel>'),
    ("INC-ST-RELPER-UNIT", RELATIVE.format(10, "ms", 100, "_undefined_")),
]


@pytest.mark.parametrize(("rule", "text"), AMBIGUOUS)
def test_nothing_is_guessed(rule, text, tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(MODEL.format(text))
    before = path.read_bytes()
    run = amuros("check", "--fix", "--select", rule, path)
    assert rule in run.stdout
    assert "repaired" not in run.stderr
    assert path.read_bytes() == before


def test_ids_order_and_redundant_values_become_those_of_emf(tmp_path):
    path = tmp_path / "model.amxmi"
    path.write_text(MODEL.format('<stimuliModel/><swModel><tasks name="T" preemption="_undefined_"/></swModel>'))
    before = meaning(load(path))
    run = amuros("check", "--select", "EMF-*", path)
    assert [line.split()[1] for line in run.stdout.splitlines() if "info:" in line] == ["EMF-DEFAULT", "EMF-ID", "EMF-ORDER"]
    assert amuros("check", "--fix", "--select", "EMF-*", path).stdout == "no findings\n"
    assert amuros("fmt", "--check", path).returncode == 0
    assert sorted(map(str, meaning(load(path))[0][1])) == sorted(map(str, before[0][1]))


def test_of_several_files_only_the_changed_ones_are_written(tmp_path):
    wrong, fine = tmp_path / "wrong.amxmi", tmp_path / "fine.amxmi"
    wrong.write_text(MODEL.format(RELATIVE.format(10, "ms", 100, "us")))
    fine.write_text((DATA / "brake.amxmi").read_text())
    before = fine.stat().st_mtime_ns
    amuros("check", "--fix", "--select", "INC-ST-*", wrong, fine)
    assert 'value="10000" unit="us"' in wrong.read_text()
    assert fine.stat().st_mtime_ns == before


def test_a_description_is_left_to_its_author(tmp_path):
    path = tmp_path / "app.yaml"
    path.write_text((ROOT / "samples" / "bodas-test-simple.yaml").read_text())
    before = path.read_bytes()
    assert "a description is not repaired" in amuros("check", "--fix", path).stderr
    assert path.read_bytes() == before


def test_a_preview_shows_the_repairs_and_writes_nothing(tmp_path):
    rule, before, _ = CASES[0]
    path = tmp_path / "model.amxmi"
    path.write_text(MODEL.format(before))
    run = amuros("check", "--fix", "--diff", "--select", rule, path)
    assert run.returncode == 1
    assert run.stderr == f"{path}: {rule} would be repaired in 1 object\n"
    assert [line for line in run.stdout.splitlines() if line[0] in "+-"] == [
        f"--- {path}",
        f"+++ {path} (repaired)",
        '-      <lowerBound value="10" unit="ms"/>',
        '+      <lowerBound value="10000" unit="us"/>',
    ]
    assert path.read_text() == MODEL.format(before)
    amuros("check", "--fix", "--select", rule, path)
    again = amuros("check", "--fix", "--diff", "--select", rule, path)
    assert (again.returncode, again.stdout, again.stderr) == (0, "", "")


def test_a_preview_without_repairs_is_wrong_use():
    run = amuros("check", "--diff", DATA / "brake.amxmi")
    assert run.returncode == 2
    assert "add --fix" in run.stderr


@pytest.mark.parametrize("tasks", ['<tasks name="T"/><tasks name="T"/>', '<tasks name="T"/><tasks/>'])
def test_no_object_gets_the_name_that_a_dangling_reference_expects(tasks, tmp_path):
    """It would get another meaning, without a word."""
    path = tmp_path / "model.amxmi"
    allocations = "".join(f'<taskAllocation task="{name}?type=Task"/>' for name in ("T_1", "Task_1"))
    path.write_text(MODEL.format(f"<swModel>{tasks}</swModel><mappingModel>{allocations}</mappingModel>"))
    assert amuros("check", "--fix", "--select", "AM-EMF-INTRINSIC/*", path).stdout.count("is not defined") == 2


def test_many_objects_are_named_in_one_pass(tmp_path, monkeypatch):

    path = tmp_path / "model.amxmi"
    path.write_text(MODEL.format(f"<swModel>{'<labels/>' * 300}</swModel>"))
    walks = []
    once = Context.referred.func
    monkeypatch.setattr(Context, "referred", property(lambda context: walks.append(1) or once(context)))
    fix_files(path)
    assert len(walks) < 10
    assert len({label.name for label in load(path).root.sw_model.labels}) == 300


def test_one_run_repairs_everything_and_makes_nothing_worse(tmp_path):
    """For what every rule with a repair complains about, alone and together with that of another one."""

    checks = [check for check in map(registry.check, registry.ids()) if isinstance(check, ModelCheck)]
    examples = [registry.kind(check.id).fails for check in checks if check.fix or check.in_canonical_form]
    repairable = [example for example in examples if example and "<am:" not in example]
    path = tmp_path / "model.amxmi"
    neighbours = zip(repairable, [*repairable[1:], repairable[0]], strict=True)
    for excerpt, other in [*((one, "") for one in repairable), *neighbours]:
        path.write_text(MODEL.format(excerpt + other))
        before = Counter(finding.rule for finding in check_files(path).findings)
        assert any(model.changed for model in fix_files(path).models)
        after = Counter(finding.rule for finding in check_files(path).findings)
        assert not after - before
        assert not any(model.changed for model in fix_files(path, write=False).models)
