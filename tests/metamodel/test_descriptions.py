"""The descriptions behind the docstrings of the generated classes: complete, well-formed, and of things that exist."""

from pathlib import Path

from amalthea_uros.metamodel import classes
from amalthea_uros.metamodel.features import ElementFeature
from amalthea_uros.metamodel.versions import facts, supported_versions

TEXT = (Path(__file__).parents[2] / "tools" / "metamodel_descriptions.txt").read_text(encoding="utf-8")
ENTRIES = [(name, text.strip()) for name, colon, text in (line.partition(":") for line in TEXT.splitlines()) if colon]
DECLARED = [facts(version) for version in supported_versions()]
TYPES = {name for declared in DECLARED for name in declared.classes.keys() | declared.enums.keys()}
FEATURES = {
    f"{cls.name}.{feature.name}"
    for declared in DECLARED
    for cls in declared.classes.values()
    for feature in cls.features
    if feature.stored
}


def shown(entry: str) -> bool:
    """Whether a generated class declares the feature, so that its docstring is the place of the text."""
    class_name, _, feature_name = entry.partition(".")
    declared = vars(getattr(classes, class_name)).values()
    return any(isinstance(feature, ElementFeature) and feature.xml_name == feature_name for feature in declared)


def test_entries_name_what_the_versions_declare() -> None:
    assert [name for name, _ in ENTRIES if name not in TYPES | FEATURES] == []


def test_features_are_described_where_the_generated_classes_declare_them() -> None:
    assert [name for name, _ in ENTRIES if "." in name and not shown(name)] == []


def test_every_class_and_enumeration_is_described() -> None:
    assert sorted(TYPES - {name for name, _ in ENTRIES}) == []


def test_entries_are_unique() -> None:
    names = [name for name, _ in ENTRIES]
    assert sorted({name for name in names if names.count(name) > 1}) == []


def test_lines_without_an_entry_are_comments() -> None:
    others = [line for line in TEXT.splitlines() if ":" not in line]
    assert [line for line in others if line and not line.startswith("# ")] == []


def test_texts_are_sentences_that_fit_into_docstrings() -> None:
    quoted = set('"\\`')
    fits = [text.endswith(".") and text[0].isupper() and len(text) <= 200 and not quoted & set(text) for _, text in ENTRIES]
    assert [entry for entry, fit in zip(ENTRIES, fits, strict=True) if not fit] == []
