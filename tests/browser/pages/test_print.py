"""Every page prints what one reads: no rail, no bar, no buttons, dark ink on white, whatever the theme."""

from __future__ import annotations

import pytest

from gpsr_site.pages.places import all_places
from tests.browser.faults import SETTLED
from tests.gpsr_site.routes.addresses import address

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

NOT_PRINTED = ".rail, .topbar, .banner, .sheet-bar, .run-start, .tick, .page-head > .actions"
SHOWN = f"""() => [...document.querySelectorAll("{NOT_PRINTED}")]
  .filter((each) => each.checkVisibility()).map((each) => each.className)"""
COLOURS = """() => {
  const lightness = (colour) => {
    const canvas = new OffscreenCanvas(1, 1).getContext("2d");
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    const [red, green, blue] = canvas.getImageData(0, 0, 1, 1).data;
    return (red + green + blue) / 3;
  };
  const { backgroundColor, color } = getComputedStyle(document.body);
  return [lightness(backgroundColor), lightness(color)];
}"""
A4_WIDTH = 688  # CSS pixels between margins of 14 mm


@pytest.mark.parametrize("theme", ["system", "chosen"])
def test_every_page_prints_light_and_without_its_frame(theme, page_of, live_server, sample, admin):
    page = page_of(admin)
    page.emulate_media(media="print", color_scheme="dark")
    page.set_viewport_size({"width": A4_WIDTH, "height": 900})
    faults = []
    for place in all_places():
        answer = page.goto(live_server.url + address(place.page, sample))
        assert answer.status < 400, place
        if theme == "chosen":
            page.evaluate("document.documentElement.dataset.theme = 'dark'")
        page.evaluate(SETTLED)
        ground, ink = page.evaluate(COLOURS)
        shown = page.evaluate(SHOWN)
        if shown or ground < 250 or ink > 100 or not page.locator("h1").is_visible():
            faults.append((place.label, shown, ground, ink))
    assert faults == []


def test_the_legend_of_results_is_printed(page_of, live_server, sample, admin):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/results/")
    legend = page.get_by_role("tooltip", include_hidden=True)
    assert not legend.is_visible()
    page.emulate_media(media="print")
    assert legend.is_visible()
