"""`amuros migrate` as people and programs see it, and what the other commands say of old models."""

import json
import re

import pytest
from click.testing import CliRunner
from command import amuros

from amalthea_uros.cli.models import migrate as command
from amalthea_uros.xmi.emf.versions import VERSIONS, version_of

SPACES = 'xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
MODEL = """<am:Amalthea {} xmlns:am="http://app4mc.eclipse.org/amalthea/{}">
<swModel>{}
</swModel>
</am:Amalthea>
"""


def model(path, version="0.9.8", content='\n<labels name="L"/>'):
    path.write_text(MODEL.format(SPACES, version, content))
    return path


def run(*arguments):
    return CliRunner().invoke(command, [str(argument) for argument in arguments], catch_exceptions=False)


def test_the_report_says_what_was_written(tmp_path):
    path = model(tmp_path / "a.amxmi")
    result = run(path)
    assert result.exit_code == 0
    assert result.stdout == (
        f"Files\n  {path}: AMALTHEA 0.9.8, written to {tmp_path / 'a-3.3.0.amxmi'}\n\n"
        "1 file: AMALTHEA 0.9.8 -> 3.3.0, nothing else to convert\n"
    )


def test_what_is_lost_makes_the_exit_code_1(tmp_path):
    path = model(tmp_path / "a.amxmi", content='\n<labels name="L"/>\nto do\n<labels name="M"/>\nand | more')
    result = run(
        path, "--output", "text", "--output", f"json={tmp_path / 'r.json'}", "--output", f"markdown={tmp_path / 'r.md'}"
    )
    assert result.exit_code == 1
    assert result.stdout.splitlines()[3:] == [
        "Reading",
        "  number        what                       example  first",
        f"       2  lost  text between the elements  'to do'  {path}:2",
        "",
        "1 file: AMALTHEA 0.9.8 -> 3.3.0, 2 lost",
    ]
    report = json.loads((tmp_path / "r.json").read_text())
    assert (report["from"], report["to"]) == ("0.9.8", "3.3.0")
    assert [change["kind"] for change in report["changes"]] == ["lost", "lost"]
    assert report["changes"][0] == {
        "kind": "lost",
        "step": None,
        "message": "text between the elements",
        "detail": "'to do'",
        "object": "Amalthea / swModel",
        "file": str(path),
        "line": 2,
        "column": 1,
    }
    page = (tmp_path / "r.md").read_text()
    assert page.startswith("# Migration to AMALTHEA 3.3.0\n\n**1 file: AMALTHEA 0.9.8 -\\> 3.3.0, 2 lost**\n")
    assert f"| Amalthea / swModel | {path}:2:1 | text between the elements | 'and \\| more' |" in page


def test_no_text_of_a_model_is_markup_in_the_report(tmp_path):
    odd = "a&#10;b|c&lt;b>_x_y_ __z `k` &amp;lt; &#13;R ~~s~~ *s* [l](u) &#x2028;\\"
    content = f'</swModel><measurementModel><measurements><runtimes unit="{odd}"/></measurements></measurementModel><swModel>'
    path = model(tmp_path / "a.amxmi", "0.9.9", content)
    result = run(path, "--dry-run", "--output", "markdown")
    lost, step = [line for line in result.stdout.splitlines() if "no longer supported" in line]
    assert r"a\nb\|c\<b\>\_x_y\_ \_\_z \`k\` \&lt; \rR \~\~s\~\~ \*s\* \[l\](u) \u2028\\ |" in lost
    # An example is one line that is cut.
    assert r"a b\|c\<b\>\_x_y\_ \_\_z \`k\` \&lt; R \~\~s\~\~ \*s\* \[l\](... |" in step
    assert [len(re.findall(r"(?<!\\)\|", row)) for row in (lost, step)] == [5, 6]


def test_what_is_not_migrated_makes_the_exit_code_2_and_the_rest_is_written(tmp_path):
    folder = tmp_path / "models"
    folder.mkdir()
    model(folder / "a.amxmi")
    model(folder / "b.amxmi", "3.9.0")
    result = run(folder)
    assert result.exit_code == 2
    assert "XMI103 error: AMALTHEA 3.9.0 is not a known version, so it cannot be migrated" in result.stderr
    assert result.stdout.splitlines()[-1] == ("1 file: AMALTHEA 0.9.8 -> 3.3.0, nothing else to convert, 1 file not written")
    assert (tmp_path / "models-3.3.0" / "a.amxmi").exists()


def test_a_dry_run(tmp_path):
    path = model(tmp_path / "a.amxmi")
    result = run("--dry-run", path)
    assert (result.exit_code, result.stdout.splitlines()[-1]) == (
        0,
        "1 file: AMALTHEA 0.9.8 -> 3.3.0, nothing else to convert, dry run",
    )
    assert [file.name for file in tmp_path.iterdir()] == ["a.amxmi"]


def test_steps_are_in_the_order_in_which_they_were_taken(tmp_path):
    semaphore = '</swModel><osModel><semaphores name="S" semaphoreType="CountingSemaphore"{}/></osModel><swModel>'
    newer, older = tmp_path / "newer", tmp_path / "older"
    for folder in (newer, older):
        folder.mkdir()
    model(
        newer / "a.amxmi",
        "3.3.0",
        "to do" + semaphore.format(' ownership="true"') + '<labels name="L" dataType="X?type=BaseTypeDefinition"/>',
    )
    model(older / "a.amxmi", "0.9.5", "to do" + semaphore.format(' maxValue="0"') + '<tasks name="T"><callGraph/></tasks>')
    headings = [
        [
            line
            for line in run(folder / "a.amxmi", "--dry-run", "--to", version).stdout.splitlines()
            if line.startswith(("To", "Read"))
        ]
        for folder, version in ((newer, "1.2.0"), (older, "3.3.0"))
    ]
    assert headings == [
        ["Reading", "To AMALTHEA 2.2.0", "To AMALTHEA 2.0.0"],
        ["Reading", "To AMALTHEA 0.9.7", "To AMALTHEA 2.1.0", "To AMALTHEA 3.0.0"],
    ]


def test_nothing_to_do(tmp_path):
    result = run(model(tmp_path / "a.amxmi", "3.3.0"))
    assert (result.exit_code, result.stdout.splitlines()[-1]) == (0, "1 file has AMALTHEA 3.3.0 already")


def test_many_versions_are_a_range(tmp_path):
    for version in ("0.9.8", "1.0.0", "1.1.0", "3.0.0"):
        model(tmp_path / f"{version}.amxmi", version)
    result = run(tmp_path, "-o", tmp_path / "new")
    assert result.stdout.splitlines()[-1] == "4 files: AMALTHEA 0.9.8 to 3.0.0 -> 3.3.0, nothing else to convert"


def test_wrong_use(tmp_path):
    path = model(tmp_path / "a.amxmi")
    unknown = amuros("migrate", path, "--to", "3.3")
    assert (unknown.returncode, unknown.stdout) == (2, "")
    assert "unknown AMALTHEA version '3.3'; did you mean '3.3.0'" in unknown.stderr
    assert "--in-place and -o exclude each other" in run(path, "--in-place", "-o", tmp_path / "b.amxmi").stderr
    missing = run(tmp_path / "none.amxmi")
    assert missing.exit_code == 2
    assert "XMI001 error: file not found" in missing.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["a.amxmi"]


def test_the_other_commands_say_that_a_model_was_migrated(tmp_path):
    path = model(tmp_path / "a.amxmi", "0.8.2")
    before = path.read_bytes()
    info = amuros("info", path)
    assert info.stdout.startswith(f"{path}: AMALTHEA 0.8.2, migrated to 3.3.0 in memory, ")
    assert "XMI008 info" in info.stderr
    assert "XMI008 info" in amuros("check", path).stdout
    fixed = amuros("check", "--fix", path)
    assert f"{path}: a model of AMALTHEA 0.8.2 is not repaired; migrate it first: amuros migrate {path}\n" in fixed.stderr
    formatted = amuros("fmt", path)
    assert formatted.returncode == 2
    assert "XMI104 error: a model of AMALTHEA 0.8.2 has no canonical form" in formatted.stderr
    assert path.read_bytes() == before


@pytest.mark.parametrize("command", [["check", "--fix"], ["info"], ["migrate", "--to", "ITEA 1.3.0"]])
def test_versions_of_itea_are_not_called_amalthea(command, tmp_path):
    (tmp_path / "a.amxmi").write_text('<c:AMALTHEA xmlns:c="http://www.amalthea.itea2.org/model/1.3.0/central"/>')
    result = amuros(*command, tmp_path / "a.amxmi")
    assert "ITEA 1.3.0" in result.stdout
    assert "AMALTHEA ITEA" not in result.stdout + result.stderr


def test_models_of_different_versions_are_compared(tmp_path):
    old, new = model(tmp_path / "a.amxmi", "0.8.2"), model(tmp_path / "b.amxmi", "2.0.0", "")
    result = amuros("diff", old, new)
    assert result.returncode == 1
    assert "- Label L\n" in result.stdout
    assert result.stderr.count("XMI008 info") == 2


@pytest.mark.parametrize("version", [version for version in VERSIONS if not version.startswith("ITEA")])
def test_every_version_is_read_and_written(version, tmp_path):
    path = model(tmp_path / "a.amxmi", version)
    assert run(path, "-o", tmp_path / "b.amxmi").exit_code in (0, 1)
    assert version_of((tmp_path / "b.amxmi").read_bytes()) == "3.3.0"
