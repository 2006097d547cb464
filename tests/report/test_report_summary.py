"""The summary of a report for comments of CI systems."""

from support import ROOT

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
