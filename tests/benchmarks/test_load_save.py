import json
import sys

from load_save import Row, help_verdict, main, table, verdicts
from measure import VARIANTS


def rows(**cpu: float) -> list[Row]:
    """Rows with one sample each for the variants named with underscores; the others failed."""
    samples = {name.replace("_", " "): {"wall": value, "cpu": value, "once": 0.1, "peak": 5e7} for name, value in cpu.items()}
    return [Row(v, [samples[v]]) if v in samples else Row(v, note="not there") for v in VARIANTS]


def test_verdicts_compare_with_the_targets():
    lines = [v.line() for v in verdicts(rows(lxml_parse=0.1, amuros_load=0.25, amuros_save=0.2, pyecore_load=6.0))]
    assert [line.split()[-1] for line in lines] == ["met", "met", "MISSED", "measured"]
    assert "2.50" in lines[0]
    assert "24.00" in lines[1]


def test_help_is_judged_by_its_median():
    assert help_verdict([0.07, 0.079, 0.5]).met is True
    assert help_verdict([]).met is None


def test_table_tells_why_a_variant_is_missing():
    lines = table(rows(lxml_parse=0.05, amuros_load=0.25))
    assert any(line.split() == ["amuros", "load", *["0.250"] * 4, "5.0", "0.10", "50"] for line in lines)
    assert any(line.split() == ["pyecore", "load", "not", "there"] for line in lines)


def test_command_measures_and_reports(tmp_path, monkeypatch, capsys):
    report = tmp_path / "figures.json"
    monkeypatch.setattr(sys, "argv", ["load_save.py", "--elements", "300", "--repeat", "1", "--json", str(report)])
    main()
    assert "lxml parse" in capsys.readouterr().out
    (file,) = json.loads(report.read_text())["files"]
    assert file["rows"][0]["samples"][0]["cpu"] > 0
