"""Changes of files: exact for programs such as `patch`, harmless on a terminal."""

from io import StringIO
from pathlib import Path

from amalthea_uros.report import formats
from amalthea_uros.services.files import FileChange, FilesDiff


class Screen(StringIO):
    def isatty(self):
        return True


def written(before, after, stream, name="m.amxmi"):
    formats.write("text", FilesDiff((FileChange(Path(name), before, after),), "canonical"), stream)
    return stream.getvalue()


def test_a_pipe_gets_the_characters_of_the_file():
    assert written("\t\x1b[31mold\r\n", "new\n", StringIO()).endswith("@@ -1 +1 @@\n-\t\x1b[31mold\r\n+new\n")


def test_a_terminal_gets_escapes_of_hidden_characters_except_tabs():
    assert written("\t\x1b[31mold\r\n", "new\n", Screen()).endswith("@@ -1 +1 @@\n-\t\\x1b[31mold\\r\n+new\n")


def test_only_a_line_feed_ends_a_line():
    """As for `patch`: a line separator or form feed in a comment is part of its line."""
    assert "@@ -1,2 +1,2 @@\n a\u2028b\x0cc\n-old\n+new\n" in written(
        "a\u2028b\x0cc\nold\n", "a\u2028b\x0cc\nnew\n", StringIO()
    )


def test_a_last_line_without_a_line_end_is_marked():
    """As in POSIX.1-2017, diff, "Diff Default Output Format"."""
    assert written("old", "new\n", StringIO()).endswith("-old\n\\ No newline at end of file\n+new\n")


def test_the_name_of_a_file_stays_in_its_line():
    assert "--- a\\nb.amxmi\n" in written("old\n", "new\n", StringIO(), "a\nb.amxmi")
