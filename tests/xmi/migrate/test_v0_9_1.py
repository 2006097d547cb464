"""0.9.0 -> 0.9.1: what the vectors do not show."""

import pytest
from migration import migrated

TEXT = """<am:Amalthea xmlns:am="http://app4mc.eclipse.org/amalthea/{}" xmlns:xmi="http://www.omg.org/XMI"
  xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmi:version="2.0">
  <stimuliModel>
    <stimuli xsi:type="am:PeriodicStimulus" name="P">
      <customProperties key="k">
        <value xsi:type="am:MapObject">
          <entries key="a"><value xsi:type="am:TimeObject" value="1" unit="ms"/></entries>
        </value>
      </customProperties>
      <jitter><lowerBound xsi:type="am:TimeObject" value="1" unit="ms"/></jitter>
    </stimuli>
  </stimuliModel>
</am:Amalthea>"""


@pytest.mark.parametrize(("version", "target"), [("0.9.0", "0.9.1"), ("0.9.1", "0.9.2"), ("0.9.2", "0.9.2")])
def test_times_everywhere(tmp_path, version, target):
    path = tmp_path / "model.amxmi"
    path.write_text(TEXT.format(version))
    models, _ = migrated([path], target)
    assert {node.type for node in models.trees[0].root.walk() if node.get("unit")} == {"Time"}
