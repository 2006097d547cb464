"""`amuros check --fix`: what is repaired, and what is not."""

import pytest
from support import DATA, MODEL, ROOT, meaning
from test_cli import amuros

from amalthea_uros import load

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
