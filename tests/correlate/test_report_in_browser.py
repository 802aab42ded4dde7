"""The report in headless Chromium with the network off: silent, alive, readable on a phone."""

import io
import shutil

import numpy as np
import pytest
from PIL import Image

from spavision.correlate.discrepancy import compare
from spavision.correlate.report import Frame, Picture, ReportContent, report_html
from spavision.correlate.summary import summarise

from .paths import make_path

playwright = pytest.importorskip("playwright.sync_api", reason="needs the browser extra")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="needs the Debian package chromium")

EVIL = "<script>document.title='taken over'</script>"
PRESSURES_kPa = (0.0, 5.0, 10.0, 15.0)


def _picture(grey, caption):
    encoded = io.BytesIO()
    Image.new("RGB", (400, 300), (grey, grey, grey)).save(encoded, "PNG")
    return Picture(encoded.getvalue(), "image/png", caption)


@pytest.fixture(scope="module")
def page_file(tmp_path_factory):
    pressure = np.array(PRESSURES_kPa)
    measured, modelled = (make_path(pressure, factor * pressure, pressure) for factor in (1.5, 1.7))
    summary = summarise(compare(measured, modelled))
    frames = [
        Frame(p, _picture(50, f"photo {p:g} {EVIL}"), _picture(200, f"model {p:g}")) for p in PRESSURES_kPa
    ]
    content = ReportContent(
        title=f"A title {EVIL}",
        summary=summary,
        sentences=[*summary.sentences(), EVIL],
        frames=frames,
        notes=[EVIL],
        tables={EVIL: [["header", EVIL], ["cell", EVIL]]},
        record={"photos": EVIL},
    )
    file = tmp_path_factory.mktemp("report") / "report.html"
    file.write_text(report_html(content), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield chromium
        chromium.close()


@pytest.fixture
def opened(browser, page_file):
    """Return a function that opens the report without a network and collects what it complains of."""
    contexts = []

    def open_page(**options):
        context = browser.new_context(offline=True, **options)
        contexts.append(context)
        page = context.new_page()
        page.complaints, page.requests = [], []
        page.on("console", lambda message: page.complaints.append(message.text))
        page.on("pageerror", lambda error: page.complaints.append(str(error)))
        page.on("request", lambda request: page.requests.append(request.url))
        page.goto(page_file.as_uri())
        page.wait_for_selector("#path-plot .main-svg")
        return page

    yield open_page
    for context in contexts:
        context.close()


def test_it_opens_in_silence_and_asks_for_nothing(opened, page_file):
    page = opened()
    assert page.complaints == []
    asked = [url for url in page.requests if not url.startswith(("data:", "blob:"))]
    assert asked == [page_file.as_uri()]
    assert page.locator("#pressure-plot .main-svg").count() > 0


def test_text_from_files_stays_text(opened):
    page = opened()
    assert page.title().startswith("A title")
    assert EVIL in page.locator("h1").inner_text()


def test_the_slider_moves_both_pictures_by_keyboard(opened):
    page = opened()
    shown = page.locator(".frame:visible img")
    assert [image.get_attribute("alt").split()[1] for image in shown.all()] == ["0", "0"]
    page.locator("#pressure-slider").focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    assert [image.get_attribute("alt").split()[1] for image in shown.all()] == ["10", "10"]
    assert page.locator("#pressure-shown").inner_text() == "10 kPa"
    page.keyboard.press("End")
    assert [image.get_attribute("alt").split()[1] for image in shown.all()] == ["15", "15"]


def test_a_phone_need_not_scroll_sideways(opened):
    page = opened(viewport={"width": 360, "height": 740}, is_mobile=True, device_scale_factor=2)
    assert page.evaluate("document.scrollingElement.scrollWidth") <= 360
    boxes = [image.bounding_box() for image in page.locator(".frame:visible img").all()]
    assert boxes[1]["y"] > boxes[0]["y"] + boxes[0]["height"] - 1, "the pictures stand one below the other"


def test_print_shows_every_pressure_and_no_slider(opened):
    """On A4 less its margins, 718 px wide, nothing is cut off."""
    page = opened(viewport={"width": 718, "height": 1000})
    page.emulate_media(media="print")
    assert page.evaluate("document.scrollingElement.scrollWidth") <= 718
    assert page.locator(".frame:visible").count() == len(PRESSURES_kPa)
    assert not page.locator("#pressure-slider").is_visible()
