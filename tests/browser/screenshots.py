"""Pictures of every page of a running installation, at two widths and in both themes.

    python -m tests.browser.screenshots OUT --url http://127.0.0.1:8000 --user NAME --world WORLD

The password is read from GPSR_PASSWORD.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright

from tests.browser.chromium import CHROMIUM
from tests.browser.variants import VARIANTS, Variant

# Name of the picture → path below the world. A path in braces is the first link of that page that
# the selector finds.
PAGES = {
    "overview": "",
    "ontology": "ontology/",
    "entity-new": "ontology/new/",
    "entities-new": "ontology/paste/",
    "location-rooms": "ontology/rooms/",
    "predicates": "predicates/",
    "predicate-new": "predicates/new/",
    "grammar": "grammar/",
    "production-new": "grammar/new/",
    "uncovered": "coverage/",
    "unmatched": "coverage/unmatched/",
    "conflicts": "coverage/conflicts/",
    "outside": "coverage/outside/",
    "templates": "templates/",
    "template-new": "templates/new/",
    "commands": "commands/",
    "forms": "forms/",
    "complexity": "commands/complexity/",
    "paraphrases": "paraphrases/",
    "paraphrase-figures": "paraphrases/figures/",
    "paraphrase-forms": "paraphrases/figures/forms/",
    "paraphrase-contributors": "paraphrases/figures/contributors/",
    "campaigns": "campaigns/",
    "campaign-new": "campaigns/new/",
    "campaign-results": "campaigns/results/",
    "deleted": "history/template/deleted/",
    "utterances": "utterances/",
    "utterances-new": "utterances/new/",
    "uploads": "utterances/uploads/",
    "label": "label/",
    "queue": "queue/",
    "audit": "audit/",
    "agreement": "queue/agreement/",
    "progress": "queue/progress/",
    "queue-settings": "queue/settings/",
    "guidelines": "guidelines/",
    "import": "import/",
    "import-competition": "import/competition/",
    "import-pairs": "import/pairs/",
    "splits": "splits/",
    "split-new": "splits/new/",
    "runs": "runs/",
    "run-new": "runs/new/?parser=seq2seq",
    "results": "results/",
    "learning-curves": "results/curves/",
    "compare-choose": "compare/",
    "slices": "slices/",
    "playground": "parse/?text=Bring+an+umbrella",
    "joint-plan": "parse/together/?command1=Bring+an+umbrella&command2=Navigate+to+the+hallway",
    "recipes": "recipes/",
    "recipe-new": "recipes/new/",
    "primitive-new": "recipes/primitives/new/",
    "promotions": "promotion/",
    "beside": "parse/?beside=usual&text=Bring+an+umbrella",
    "review": "review/?outcome=wrong",
    "error-categories": "error-categories/",
    "search": "search/?q=the",
}
# The cells of one run; those of several seeds lead to their runs.
TO_REVIEW = "a.accuracy[href*=review]"
# Name of the picture → the page and the link on it that leads there.
DETAILS = {
    "template": ("templates/", "#list a.row-link"),
    "predicate": ("predicates/", "#list a.row-link[href*=predicates]"),
    "recipe": ("recipes/", "a.row-link"),
    "primitive": ("recipes/", "a.row-link[href*=primitives]"),
    "production": ("grammar/", "#list a.row-link[href*=grammar]"),
    "entity": ("ontology/", "#list a.row-link"),
    "command": ("commands/", "#list a.row-link"),
    "upload": ("utterances/uploads/", "#list a.row-link"),
    "form": ("forms/", "#list td a"),
    "paraphrase": ("paraphrases/", "#list a.row-link"),
    "campaign": ("campaigns/", "a.row-link"),
    "split": ("splits/", "a.row-link"),
    "run": ("runs/?status=succeeded&parser=seq2seq", "#runs-table a.row-link"),
    "predictions": ("review/", "a[href*=predictions]"),
    "review-errors": ("results/", TO_REVIEW),
    "error-category": ("error-categories/", "a.row-link"),
    "seeds": ("results/", "a.accuracy[href*=seeds_of]"),
    "compare": ("compare/", ".empty a[href*=run]"),
}
# Name of the picture → path below the page of the run in ``DETAILS``.
OF_RUN = {name: f"{name}/" for name in ("defaults", "sensitivity", "probes")}


def log_in(page: Page, url: str, user: str, password: str) -> None:
    """Logs ``user`` in through the page."""
    page.goto(f"{url}/login/")
    page.fill("#id_username", user)
    page.fill("#id_password", password)
    page.click("button[type=submit]")
    page.wait_for_url(lambda address: "/login/" not in address)


def addresses(page: Page, url: str, world: str) -> Iterator[tuple[str, str]]:
    """Name and address of every page to look at; details that have nothing to show are left out."""
    yield "worlds", f"{url}/"
    yield "world-new", f"{url}/worlds/new/"
    base = f"{url}/w/{world}/"
    for name, path in PAGES.items():
        yield name, base + path
    for name, (path, selector) in DETAILS.items():
        page.goto(base + path)
        link = page.query_selector(selector)
        if link is None:
            continue
        address = link.evaluate("link => link.href")
        yield name, address
        if name == "run":
            yield from ((each, address + below) for each, below in OF_RUN.items())


def shoot(browser: Browser, variant: Variant, args: argparse.Namespace) -> None:
    """All pages in one variant."""
    context = browser.new_context(**variant.options)
    page = context.new_page()
    page.goto(f"{args.url}/login/")
    page.screenshot(path=args.out / f"login-{variant}.png")
    log_in(page, args.url, args.user, os.environ["GPSR_PASSWORD"])
    chosen = args.only.split(",") if args.only else []
    for name, address in list(addresses(page, args.url, args.world)):
        if chosen and name not in chosen:
            continue
        page.goto(address)
        page.wait_for_selector("#coverage:not([aria-busy])") if name == "grammar" else None
        page.wait_for_timeout(args.settle)
        page.screenshot(path=args.out / f"{name}-{variant}.png", full_page=args.full)
    context.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--url", default="http://127.0.0.1:8000")
    parser.add_argument("--user", default="admin")
    parser.add_argument("--world", required=True)
    parser.add_argument("--only", default="", help="names of pages, comma-separated")
    parser.add_argument("--variants", default="", help="such as 1280-light, comma-separated")
    parser.add_argument("--full", action="store_true", help="the whole length of each page")
    parser.add_argument(
        "--settle", type=int, default=600, help="milliseconds for charts to be drawn"
    )
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    wanted = args.variants.split(",") if args.variants else [str(each) for each in VARIANTS]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        for variant in VARIANTS:
            if str(variant) in wanted:
                shoot(browser, variant, args)
        browser.close()


if __name__ == "__main__":
    main()
