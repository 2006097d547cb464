"""How long `amuros report` takes on a model, how large its page is, and how soon it is open: python benchmarks/reports.py MODEL

The page is opened in Chromium where selenium and chromedriver are installed.
"""

from __future__ import annotations

import argparse
import shutil
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time

from amalthea_uros import report

_OPTIONS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run")
#: From the request to the end of the load event, with layout of all of the page.
_LOADED = (
    "document.body.getBoundingClientRect(); return performance.getEntriesByType('navigation')[0].loadEventEnd"
    " || performance.now()"
)


def main() -> None:
    parser = argparse.ArgumentParser(description="Measures reports.")
    parser.add_argument("model", type=Path, help="an app.yaml, or a file of AMALTHEA")
    path = parser.parse_args().model
    start, used = perf_counter(), process_time()
    page = report(path).html
    taken, used = perf_counter() - start, process_time() - used
    opened = f", opened in {milliseconds:.0f} ms" if (milliseconds := _opened(page)) is not None else ""
    print(f"{path.name}: {taken:.1f} s ({used:.1f} s of processor time), {len(page.encode()) / 1e6:.2f} MB{opened}")


def _opened(page: str) -> float | None:
    """Milliseconds until the page is loaded; None without a browser."""
    binary, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if binary is None or driver is None or find_spec("selenium") is None:
        return None
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    options.binary_location = binary
    with TemporaryDirectory() as folder:
        for option in (*_OPTIONS, f"--user-data-dir={folder}/profile"):
            options.add_argument(option)
        file = Path(folder) / "report.html"
        file.write_text(page, encoding="utf-8")
        browser = webdriver.Chrome(options, webdriver.ChromeService(driver))
        try:
            browser.get(file.as_uri())
            return float(browser.execute_script(_LOADED))
        finally:
            browser.quit()


if __name__ == "__main__":
    main()
