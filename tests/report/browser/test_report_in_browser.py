"""The page of a report in Chromium: it works without a network, by mouse and by keyboard, in light and dark, and on paper."""

import json
import shutil
from base64 import b64decode
from pathlib import Path

import pytest
from support import ROOT

from amalthea_uros import report
from amalthea_uros.report.pictures.gantt import GanttChart, gantt
from amalthea_uros.report.pictures.jobs import CoreRows, Job, ProcessRow, State, StateSpan
from amalthea_uros.units import MICROSECOND as US

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
AXE = ROOT / "tests" / "node" / "node_modules" / "axe-core" / "axe.min.js"
ZOOM = ROOT / "templates" / "report" / "zoom.js"
SAMPLE = ROOT / "samples" / "bodas-test-advanced.yaml"
selenium = pytest.importorskip("selenium.webdriver")
wait = pytest.importorskip("selenium.webdriver.support.wait")
pytestmark = pytest.mark.skipif(CHROMIUM is None or DRIVER is None, reason="chromium and its driver are not installed")
OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1200,900",
)
#: What an element of the page is drawn in.
COLOUR = "return getComputedStyle(document.querySelector(arguments[0])).getPropertyValue(arguments[1])"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "report.html"
    report(SAMPLE, duration="100 ms").save(path)
    return path


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    options = selenium.ChromeOptions()
    options.binary_location = CHROMIUM
    for option in (*OPTIONS, f"--user-data-dir={tmp_path_factory.mktemp('profile')}"):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = selenium.Chrome(options, selenium.ChromeService(DRIVER))
    yield driver
    driver.quit()


@pytest.fixture
def opened(browser, page):
    browser.get(page.as_uri())
    return browser


def element(browser, selector):
    return browser.find_element("css selector", selector)


def test_nothing_is_requested_and_nothing_goes_wrong(browser, page):
    browser.get_log("performance")
    browser.get(page.as_uri())
    messages = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    requested = [each["params"]["request"]["url"] for each in messages if each["method"] == "Network.requestWillBeSent"]
    # The page with which the browser starts may still be loading what belongs to the browser.
    assert [url for url in requested if not url.startswith(("data:", "chrome:"))] == [page.as_uri()]
    assert browser.get_log("browser") == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1200, 400])
def test_the_page_is_not_wider_than_the_window(opened, scheme, width):
    opened.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
    metrics = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
    opened.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    try:
        assert opened.execute_script("return document.documentElement.scrollWidth") <= width
    finally:
        opened.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_colours_follow_the_reader_and_the_button(opened):
    emulate = {"features": [{"name": "prefers-color-scheme", "value": "dark"}]}
    opened.execute_cdp_cmd("Emulation.setEmulatedMedia", emulate)

    def colours():
        drawn = (("body", "background-color"), (".amuros-picture .paper", "fill"))
        return [opened.execute_script(COLOUR, *each) for each in drawn]

    dark = colours()
    assert dark[0] == dark[1] != "rgb(255, 255, 255)"
    element(opened, "#theme").click()
    assert colours() == ["rgb(255, 255, 255)"] * 2
    assert element(opened, "#theme").text == "Dark colours"
    element(opened, "#theme").click()
    assert colours() == dark


#: The places and widths of the boxes of the chart, after they were drawn.
BOXES = (
    "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done(Array.from("
    "document.querySelector('svg[data-zoom]').querySelectorAll('[data-plot] rect'),"
    " (box) => [+box.getAttribute('x'), +box.getAttribute('width')]).flat())));"
)
LABELS = "return Array.from(document.querySelectorAll('svg > text, g[data-axis] text'), (label) => label.textContent);"
WHEEL = (
    "const box = arguments[0].getBoundingClientRect();"
    "arguments[0].dispatchEvent(new WheelEvent('wheel', {deltaY: -120, ctrlKey: true, cancelable: true,"
    " clientX: box.x + box.width / 2, clientY: box.y + box.height / 2}))"
)


def test_the_gantt_chart_is_zoomed_by_keyboard_and_mouse(opened):
    picture = element(opened, "svg[data-zoom]")
    before = pytest.approx(opened.execute_async_script(BOXES))
    picture.send_keys("+")
    assert opened.execute_async_script(BOXES) != before
    picture.send_keys("0")
    assert opened.execute_async_script(BOXES) == before
    opened.execute_script(WHEEL, picture)
    assert opened.execute_async_script(BOXES) != before


def test_zoom_keeps_the_middle_and_all_names(browser, tmp_path):
    jobs = tuple(Job(number, (StateSpan(State.RUNNING, 20 * number * US, (20 * number + 10) * US),)) for number in range(5))
    chart = gantt(GanttChart("a chart", 0, 100 * US, (CoreRows("Core_0", (ProcessRow("Task", jobs),)),)))
    path = tmp_path / "chart.html"
    path.write_text(f"<!doctype html><meta charset=utf-8><body>{chart}<script>{ZOOM.read_text()}</script>")
    browser.get(path.as_uri())
    picture = element(browser, "svg[data-zoom]")

    def shown():
        boxes = browser.execute_async_script(BOXES)
        # In one script, as each frame makes new labels.
        return boxes, browser.execute_script(LABELS)

    boxes, labels = shown()
    picture.send_keys("+")
    zoomed, _ = shown()
    assert zoomed[1::2] == pytest.approx([1.5 * width for width in boxes[1::2]])
    # The job from 40 us to 50 us ends in the middle, which stays where it is.
    assert sum(zoomed[4:6]) == pytest.approx(sum(boxes[4:6]), abs=0.1)
    picture.send_keys("0")
    assert shown() == (boxes, labels)
    picture.send_keys("nn")
    assert element(browser, ".amuros-tip").text == "Task, job 1: running for 10 us from 20 us to 30 us"


def test_the_skip_link_is_first_and_everything_has_a_visible_focus(opened):
    element(opened, "body").send_keys("\ue004")  # tab
    assert opened.switch_to.active_element.get_attribute("class") == "skip"
    opened.switch_to.active_element.send_keys("\ue004")
    assert opened.switch_to.active_element.get_attribute("id") == "theme"
    assert opened.execute_script("return getComputedStyle(document.activeElement).outlineStyle") == "solid"


def test_a_file_is_copied(opened):
    button = element(opened, ".copy")
    opened.execute_script("document.execCommand = (command) => { window.copied = String(getSelection()); return true; };")
    opened.execute_script("navigator.clipboard.writeText = async (text) => { window.copied = text; };")
    opened.execute_script("arguments[0].click()", button)
    wait.WebDriverWait(opened, 5).until(lambda _: button.text == "Copied")
    sizes = json.loads(opened.execute_script("return window.copied"))["names"]["rmw_microxrcedds"]["cmake-args"]
    assert "-DRMW_UXRCE_MAX_NODES=1" in sizes


def test_all_of_it_is_printed(opened, tmp_path):
    printed = b64decode(opened.execute_cdp_cmd("Page.printToPDF", {"printBackground": False})["data"])
    assert printed.startswith(b"%PDF")
    opened.execute_script("window.dispatchEvent(new Event('beforeprint'))")
    assert opened.execute_script("return document.querySelectorAll('details:not([open])').length") == 0
    opened.execute_script("window.dispatchEvent(new Event('afterprint'))")
    assert opened.execute_script("return document.querySelectorAll('details[open]').length") == 0


@pytest.fixture(scope="module", params=["met", "missed", "unknown"])
def verdict_page(request, page, tmp_path_factory):
    if request.param == "met":
        return page
    # In each millisecond, Control_Function takes more than the executor leaves; or so much that it may be late when a message arrives.
    time = {"missed": "999us", "unknown": "980us"}[request.param]
    path = tmp_path_factory.mktemp("verdict") / "report.html"
    report(SAMPLE, duration="20 ms", changes={"Control_Function.execution_time": time}).save(path)
    return path


@pytest.mark.skipif(not AXE.exists(), reason="axe-core is not installed: npm ci in tests/node")
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_is_accessible(browser, verdict_page, scheme):
    browser.get(verdict_page.as_uri())
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
    browser.execute_script(Path(AXE).read_text())
    browser.execute_script("for (const details of document.querySelectorAll('details')) details.open = true")
    found = browser.execute_async_script("axe.run().then(arguments[arguments.length - 1])")
    serious = [each for each in found["violations"] if each["impact"] in ("serious", "critical")]
    assert [(each["id"], [node["html"][:200] for node in each["nodes"][:3]]) for each in serious] == []
