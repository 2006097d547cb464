"""Draw what a command prints as an SVG picture: python tools/draw_terminal.py OUT.svg COMMAND...

The command runs in the folder `samples`, with colours.
"""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from html import escape
from pathlib import Path

ROOT = Path(__file__).parent.parent
WIDTH, HEIGHT, MARGIN = 8.43, 19, 16
COLOURS = {"1": "#ffffff", "2": "#8b949e", "31": "#ff7b72", "32": "#7ee787", "33": "#e3b341", "34": "#79c0ff", "36": "#76e3ea"}
STYLE = re.compile(r"\x1b\[(\d+)m(.*?)\x1b\[0m")


def run(command: list[str]) -> str:
    """What the command prints on a terminal."""
    master, slave = pty.openpty()
    environment = {key: value for key, value in os.environ.items() if key != "NO_COLOR"} | {
        "TERM": "xterm-256color",
        "COLUMNS": "100",
    }
    process = subprocess.Popen(command, stdout=slave, stderr=slave, cwd=ROOT / "samples", env=environment)
    os.close(slave)
    output = b""
    while True:
        try:
            chunk = os.read(master, 65536)
        except OSError:
            break
        if not chunk:
            break
        output += chunk
    process.wait()
    # What is written after the start of a line again replaces it, such as the progress of a command on a slow computer.
    return re.sub(r"[^\n]*\r", "", output.decode().replace("\r\n", "\n"))


def spans(line: str) -> str:
    """A line of text with ANSI styles as SVG text spans."""
    styled = STYLE.sub(lambda m: f"\x00{m[1]}\x01{m[2]}\x02", line)
    pieces = []
    for piece in re.split(r"(\x00.*?\x02)", styled):
        if piece.startswith("\x00"):
            code, _, text = piece[1:-1].partition("\x01")
            weight = ' font-weight="bold"' if code == "1" else ""
            pieces.append(f'<tspan fill="{COLOURS[code]}"{weight}>{escape(text)}</tspan>')
        elif piece:
            pieces.append(escape(piece))
    return "".join(pieces)


def draw(prompt: str, output: str) -> str:
    """An SVG picture of a terminal."""
    lines = [f"\x1b[32m$\x1b[0m {prompt}", *output.rstrip("\n").split("\n")]
    width = max(len(STYLE.sub(r"\2", line)) for line in lines) * WIDTH + 2 * MARGIN
    height = len(lines) * HEIGHT + 2 * MARGIN
    rows = "\n".join(
        f'<text x="{MARGIN}" y="{MARGIN + (i + 0.75) * HEIGHT:g}" xml:space="preserve">{spans(line)}</text>'
        for i, line in enumerate(lines)
        if line
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height}" width="{width:.0f}" height="{height}" '
        'font-family="ui-monospace, Menlo, Consolas, DejaVu Sans Mono, monospace" font-size="14" fill="#c9d1d9">\n'
        f'<rect width="100%" height="100%" rx="8" fill="#0d1117"/>\n{rows}\n</svg>\n'
    )


def main(target: Path, command: list[str]) -> None:
    target.write_text(
        draw("amuros " + " ".join(command), run([sys.executable, "-m", "amalthea_uros", *command])), encoding="utf-8"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
