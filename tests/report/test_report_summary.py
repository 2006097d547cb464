"""The summary of a report for comments of CI systems."""

from support import ROOT

import amalthea_uros as amuros
from amalthea_uros import am, load, report, save

#: What GitHub accepts.
MOST = 65_536


def test_it_fits_in_a_comment_whatever_the_names_are(tmp_path):
    model = load(ROOT / "samples" / "executor.amxmi")
    for number, task in enumerate(model.all(am.Task)):
        task.name = "|" * 70_000 + str(number)
    save(model, tmp_path / "long.amxmi")
    assert len(report(tmp_path / "long.amxmi", with_simulation=False).markdown) < MOST


def test_names_are_no_markup(tmp_path):
    model = load(ROOT / "samples" / "executor.amxmi")
    model[am.Task, "Executor_Task"].name = "a|b <i>`c`\n# d"
    save(model, tmp_path / "names.amxmi")
    shown = report(tmp_path / "names.amxmi", with_simulation=False).markdown
    (line,) = (line for line in shown.splitlines() if line.startswith("| a"))
    assert line.startswith(r"| a\|b \<i\>\`c\`\n# d |")


def test_a_summary_says_what_its_verdict_is_subject_to(tmp_path):
    # No data flow leads from the callback to the control function: the latency is unknown.
    text = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text().replace("reads: [memory_2, input]", "reads: [input]")
    (tmp_path / "gap.yaml").write_text(text)
    found = amuros.report(tmp_path / "gap.yaml").markdown
    verdict, requirements = found.index("Schedulable: "), found.index("### 4 requirements")
    assert verdict < found.index("- CHN002 warning: ") < requirements
    (row,) = [line for line in found.splitlines() if line.startswith("| factor-to-output_reaction")]
    assert "| unknown | ≤ 25 ms |" in row
