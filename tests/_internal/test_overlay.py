"""Contents that are read instead of those of files."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from amalthea_uros._internal.files import FileError, overlaid, read_bytes


def test_a_file_has_the_content_only_inside_the_block(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"saved")
    with overlaid({path: b"typed"}):
        assert read_bytes(path, 10) == b"typed"
    assert read_bytes(path, 10) == b"saved"


def test_the_file_need_not_exist(tmp_path):
    with overlaid({tmp_path / "new": b"typed"}):
        assert read_bytes(tmp_path / "new", 10) == b"typed"
        with pytest.raises(FileError, match=r".*"):
            read_bytes(tmp_path / "other", 10)


def test_the_limit_holds(tmp_path):
    with overlaid({tmp_path / "new": b"typed"}), pytest.raises(FileError, match="larger"):
        read_bytes(tmp_path / "new", 4)


def test_other_threads_read_the_files(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"saved")
    with overlaid({path: b"typed"}), ThreadPoolExecutor() as pool:
        assert pool.submit(read_bytes, path, 10).result() == b"saved"
