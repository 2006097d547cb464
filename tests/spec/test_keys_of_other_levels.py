"""A key that another section has is an advice where to put it."""

import pytest

import amalthea_uros as amuros

START = "amuros: 1\nname: a\nhardware: nucleo-f446re\n"


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("platform: x\n", "'platform' belongs in 'hardware'."),
        (
            "middleware:\n  transport:\n    serial: {write: blocking}\n",
            "'write' belongs in 'middleware.transport.serial.driver'.",
        ),
        ("middleware: {baud_rate: 9600}\n", "'baud_rate' belongs in 'middleware.transport.serial'."),
        # A word that is nearly a key there is a misspelling.
        ("middleware: {transports: 1}\n", "Did you mean 'transport'?"),
        # What is nowhere, and what is in too many places, says nothing.
        ("middleware: {domain_id: 4}\n", "Known keys: "),
        ("middleware: {name: x}\n", "Known keys: "),
    ],
)
def test_the_advice(tmp_path, text, advice):
    path = tmp_path / "app.yaml"
    path.write_text(START + text)
    helps = [finding.help for finding in amuros.check_files(path).findings if finding.rule == "YML010"]
    assert any(each.startswith(advice) for each in helps), helps
