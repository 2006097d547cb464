"""A recording of ROS 2 -> a description of the host, with gaps for values that are not recorded."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros._internal.paths import StrPath
from amalthea_uros.services.files import save_new
from amalthea_uros.services.import_code import ImportResult, count_gaps


def is_recording(path: Path) -> bool:
    """Whether a folder is that of a CTF trace; folders of source code can have a file of the same name as its metadata."""
    from amalthea_uros.trace.ctf.metadata import is_metadata
    from amalthea_uros.trace.files import METADATA, trace_folders

    return path.is_dir() and any(is_metadata(folder / METADATA) for folder in trace_folders(path))


def import_recording(recording: StrPath, target: StrPath | None = None, *, force: bool = False) -> ImportResult:
    """Read a recording of ros2_tracing, and describe the host: its executors, nodes, callbacks and topics.

    Parameters
    ----------
    recording : the folder with the CTF trace, such as a session of `ros2 trace`
    target : the file to write; None: nothing is written
    force : replace a file that exists

    Raises
    ------
    ReadError : the recording cannot be read.
    InvalidArgumentError : no callback of ROS 2 was recorded, or several computers were.
    WriteError : the file exists, or cannot be written.
    """
    from amalthea_uros.compare.recorded.description import recorded_text
    from amalthea_uros.compare.recorded.findings import findings_of_recording
    from amalthea_uros.compare.recorded.host import read_recording

    path, file = Path(recording), None if target is None else Path(target)
    host = read_recording(path)
    text = recorded_text(host, path.resolve().name.strip() or "robot")
    if file is not None:
        save_new({file: text}, force=force)
    return ImportResult(path=file, text=text, gaps=count_gaps(text), findings=(*host.findings, *findings_of_recording(host)))
