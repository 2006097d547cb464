"""Zoom into Gantt charts of a page: times move, names stay, and everything comes back."""

import shutil

import pytest
from support import ROOT

from amalthea_uros.report.pictures.gantt import GanttChart, gantt
from amalthea_uros.report.pictures.jobs import CoreRows, Job, ProcessRow, State, StateSpan
from amalthea_uros.units import MICROSECOND

SCRIPT = ROOT / "templates" / "report" / "zoom.js"
CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
US = MICROSECOND


def picture():
    jobs = tuple(Job(number, (StateSpan(State.RUNNING, 20 * number * US, (20 * number + 10) * US),)) for number in range(5))
    return gantt(GanttChart("a chart", 0, 100 * US, (CoreRows("Core_0", (ProcessRow("Task", jobs),)),)))


def test_the_script_is_small_and_strict():
    text = SCRIPT.read_text()
    assert len(text) < 8192
    assert '"use strict";' in text
    assert "</script" not in text


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    webdriver = pytest.importorskip("selenium.webdriver")
    if CHROMIUM is None or DRIVER is None:
        pytest.skip("needs chromium and its driver")
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    profile = tmp_path_factory.mktemp("profile")
    for argument in ("headless", "no-sandbox", "disable-gpu", "disable-background-networking", "disable-component-update"):
        options.add_argument(f"--{argument}")
    options.add_argument(f"--user-data-dir={profile}")
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))
    page = profile / "page.html"
    page.write_text(f"<!doctype html><meta charset=utf-8><body>{picture()}<script>{SCRIPT.read_text()}</script>")
    driver.get(page.as_uri())
    yield driver
    driver.quit()


def boxes(browser):
    """(left, width) of the boxes, after they were drawn."""
    return browser.execute_async_script(
        "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done(Array.from("
        "document.querySelectorAll('g[data-plot] rect'), (box) => [+box.getAttribute('x'), +box.getAttribute('width')]))));"
    )


def labels(browser):
    return [
        text.get_attribute("textContent") for text in browser.find_elements("css selector", "svg > text, g[data-axis] text")
    ]


def test_keys_zoom_into_times_and_back(browser):
    svg = browser.find_element("css selector", "svg[data-zoom]")
    before, texts = boxes(browser), labels(browser)
    svg.send_keys("+")
    after = boxes(browser)
    assert [width for _, width in after] == pytest.approx([1.5 * width for _, width in before])
    # The job from 40 us to 60 us is in the middle, which stays where it is.
    middle = before[2][0] + before[2][1]
    assert after[2][0] + after[2][1] == pytest.approx(middle, abs=0.1)
    svg.send_keys("0")
    assert (boxes(browser), labels(browser)) == (before, texts)


def test_the_next_box_is_described(browser):
    svg = browser.find_element("css selector", "svg[data-zoom]")
    svg.send_keys("nn")
    tip = browser.find_element("css selector", ".amuros-tip")
    assert tip.text == "Task, job 1: running for 10 us from 20 us to 30 us"


def test_no_script_error(browser):
    assert [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"] == []
