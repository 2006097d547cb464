"""Excerpts of models for rules, and what these say of them; classes are written as in `support.model_text`."""

import pytest
from support import model_text

from amalthea_uros import check, load


def model(excerpt, folder, version="3.3.0", *others):
    """A model of files with these contents."""
    paths = [folder / f"{number}.amxmi" for number in range(1 + len(others))]
    for path, content in zip(paths, (excerpt, *others), strict=True):
        path.write_text(model_text(content, version))
    return load(*paths)


def found(rule, excerpt, folder, version="3.3.0"):
    """What a rule says of an excerpt of a model."""
    return [finding.message for finding in check(model(excerpt, folder, version), [rule])]


def messages(folder, rule, *excerpts, version="3.3.0"):
    """The same of a model of several files, in which nothing is wrong that is not meant to be."""
    read = model(excerpts[0], folder, version, *excerpts[1:])
    assert not read.findings or any("gone" in excerpt for excerpt in excerpts), read.findings
    return [finding.message for finding in check(read, [rule])]


def assert_said(said, parts):
    assert len(said) == len(parts), said
    assert all(part in message for part, message in zip(parts, said, strict=True)), said


def cases(*groups):
    """A test for each case: a rule, the content of a model, and parts of what is said of it, in order."""
    found = [pytest.param(*case, id=f"{case[0]}-{number}") for group in groups for number, case in enumerate(group)]
    return pytest.mark.parametrize(("rule", "excerpt", "said"), found)


ECU = '<hwModel>{}<structures name="ECU">{}</structures></hwModel>'


def port(name, kind="", interface=""):
    stated = "".join(f' {key}="{value}"' for key, value in (("portType", kind), ("portInterface", interface)) if value)
    return f'<ports name="{name}"{stated}/>'


def module(cls, name, *content, features=""):
    return f'<modules t="{cls}" name="{name}" {features}>{"".join(content)}</modules>'


def connection(name, first, second, tag="connections"):
    ends = "".join(f' port{n}="{end}?type=HwPort"' for n, end in ((1, first), (2, second)) if end)
    return f'<{tag} name="{name}"{ends}/>'


def runnable(name, *items, parameters="", features=""):
    return f'<runnables name="{name}" {features}>{graph(*items)}{parameters}</runnables>'


def graph(*items):
    return f"<activityGraph>{''.join(items)}</activityGraph>"


def call(called, arguments=""):
    return f'<items t="RunnableCall" runnable="{called}?type=Runnable">{arguments}</items>'


def access(kind="write", attributes="", label="L"):
    return f'<items t="LabelAccess" data="{label}?type=Label" access="{kind}" {attributes}/>'


def process(tag, name, *items):
    return f'<{tag} name="{name}">{graph(*items)}</{tag}>'
