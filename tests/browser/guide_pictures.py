"""The pictures of the guides, in docs/images, from a running installation with its starter world trained.

    GPSR_PASSWORD=… python -m tests.browser.guide_pictures --url http://127.0.0.1:8000

They show what is right of the rail. Makes the world ``empty``, unless it is there, for the pages that have nothing to
show yet, and follows the tutorial, for which there must be no world ``greenhouse``. review-long.png and import.png need
worlds of their own, and are not made here.
"""

from __future__ import annotations

import argparse
import os
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

from tests.browser.chromium import CHROMIUM
from tests.browser.faults import SETTLED
from tests.browser.screenshots import log_in
from tests.browser.tutorial import Follower
from tests.browser.variants import WIDE_LIGHT

DOCS = Path(__file__).resolve().parents[2] / "docs"
IMAGES = DOCS / "images"
TUTORIAL = DOCS / "guides" / "greenhouse.md"
# Of the tutorial, which says where each is taken: name → height.
OF_TUTORIAL = {
    "greenhouse-lines": 600,
    "greenhouse-try": 800,
    "greenhouse-parse": 460,
    "greenhouse-plan": 430,
}
TALL = {"width": 1280, "height": 1000}  # pictures may be higher than a usual window
MOST_BYTES = 150_000
EMPTY = "empty"
LONG = (
    "could+you+please+go+over+to+the+kitchen+look+for+the+tumbler+that+somebody+left+next+to+the+sink+"
    "and+then+bring+it+back+to+me+here+in+the+living+room+before+our+guests+arrive"
)


@dataclass(frozen=True, slots=True)
class Picture:
    """A page below a world; ``waits_for`` is a part that comes a moment later."""

    name: str
    path: str
    height: int = 620
    waits_for: str = "h1"
    world: str = ""


PICTURES = (
    Picture("review", "review/", 552, ".review-answer"),
    Picture("review-empty", "review/", 250, world=EMPTY),
    Picture("start-a-run", "runs/new/", 752, "[name=parser]:checked"),
    Picture("template-editor", "templates/", 740, ".cm-editor >> nth=1"),
    Picture("settings", "people/"),
    Picture("import-empty", "import/", world=EMPTY),
    Picture("results", "results/", 752, "a.accuracy"),
    Picture("results-empty", "results/", 360, world=EMPTY),
    Picture("parse", "parse/?text=bring+me+the+tumbler+from+the+kitchen", 752, ".playground-heard"),
    Picture("parse-long", f"parse/?text={LONG}", 752, ".playground-heard"),
)


def make_empty_world(page: Page, url: str) -> None:
    if page.goto(f"{url}/w/{EMPTY}/").status != 404:
        return
    page.goto(f"{url}/worlds/new/")
    page.fill("#id_name", EMPTY)
    page.get_by_role("button", name="Create world").click()
    page.wait_for_url(f"**/w/{EMPTY}/**")


def take(page: Page, url: str, world: str, picture: Picture) -> None:
    page.goto(f"{url}/w/{picture.world or world}/{picture.path}")
    if picture.path == "templates/":
        page.locator("#list a.row-link").nth(2).click()
    page.locator(picture.waits_for).first.wait_for()
    shoot(page, picture.name, picture.height)


def follow_tutorial(page: Page, url: str) -> None:
    """Make the world of the tutorial as it says, and its pictures on the way."""
    page.set_viewport_size(TALL)
    page.goto(url)
    Follower(page, take=lambda name: shoot(page, name, OF_TUTORIAL[name])).follow(TUTORIAL)


def shoot(page: Page, name: str, height: int) -> None:
    """Take a picture of the top of what is right of the rail."""
    page.evaluate(SETTLED)
    page.wait_for_timeout(600)  # what the editor asks once its text is there
    top, left = (page.locator(part).first.bounding_box() for part in (".topbar", "main"))
    assert top and left
    clip = {"x": left["x"], "y": top["height"], "width": left["width"], "height": height}
    path = IMAGES / f"{name}.png"
    page.screenshot(path=path, clip=clip)
    size = path.stat().st_size
    print(f"{path.name}: {size // 1000} kB")
    if size > MOST_BYTES:
        raise SystemExit(f"{path.name} has more than {MOST_BYTES} bytes.")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--url", default="http://127.0.0.1:8000")
    parser.add_argument("--user", default="admin")
    parser.add_argument("--world", default="household")
    parser.add_argument("--only", default="", help="names of pictures, comma-separated")
    args = parser.parse_args()
    chosen = (
        args.only.split(",") if args.only else [*OF_TUTORIAL, *(each.name for each in PICTURES)]
    )
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_context(**WIDE_LIGHT.options).new_page()
        log_in(page, args.url, args.user, os.environ["GPSR_PASSWORD"])
        make_empty_world(page, args.url)
        for each in PICTURES:
            if each.name in chosen:
                take(page, args.url, args.world, each)
        if not OF_TUTORIAL.keys().isdisjoint(chosen):
            follow_tutorial(page, args.url)
        browser.close()


if __name__ == "__main__":
    main()
