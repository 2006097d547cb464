"""Where the files that are shipped beside the code are found."""

from __future__ import annotations

from pathlib import Path
from typing import Any

_PACKAGE = Path(__file__).parents[1]


def resource_folder(name: str) -> Path:
    """A folder such as `schemas` or `templates/report`: inside the package when installed, beside it in a checkout."""
    installed = _PACKAGE / name
    return installed if installed.is_dir() else _PACKAGE.parent / name


#: The folder of the platforms, which are data and no code.
PLATFORMS = _PACKAGE / "platforms"
#: The folder of the operating systems, which are data, too.
RTOSES = PLATFORMS / "rtos"
#: The folder of the profiles of measured times, which are data, too.
MEASURED = PLATFORMS / "measured"


def known_platforms() -> list[str]:
    """The names of the platforms that come with this package."""
    return sorted(path.stem for path in PLATFORMS.glob("*.yaml"))


def known_rtoses() -> list[str]:
    """The names of the operating systems that come with this package."""
    return sorted(path.stem for path in RTOSES.glob("*.yaml"))


def known_measured() -> list[str]:
    """The names of the profiles of measured times that come with this package."""
    return sorted(path.stem for path in MEASURED.glob("*.yaml"))


def yaml_data(path: Path) -> Any:
    """The content of a YAML file that is shipped with the package."""
    return parsed_yaml(path.read_text(encoding="utf-8"))


def parsed_yaml(text: str) -> Any:
    """The content of a YAML text that is shipped with the package."""
    import yaml

    return yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
