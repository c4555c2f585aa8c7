"""Labels published paraphrases in one sitting by keyboard alone, in a headless Chromium.

    .venv/bin/python -m benchmarks.annotation.labelling PAIRS --url http://127.0.0.1:8000 --world WORLD [--count 50]

PAIRS is a pair file such as ``para/train.txt``; its forms say which candidate is right. The password of
``--user`` is read from GPSR_PASSWORD. The world should hold the generated commands and no paraphrases. Printed:
how often the right form was candidate 1, or one of 1–9, or had to be written; how long the page took from
the key to the next utterance, in milliseconds. Without ``--pause`` the keys come faster than any person's, so that
the next utterance has not been fetched yet.
"""

from __future__ import annotations

import argparse
import os
import random
import statistics
import time
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

from tests.browser.chromium import CHROMIUM
from tests.browser.screenshots import log_in


def read_pairs(path: Path, count: int, seed: int) -> dict[str, str]:
    """Return ``count`` utterances with their forms, drawn by ``seed``."""
    lines = path.read_text(encoding="utf-8").splitlines()
    pairs = list(zip(lines[::2], lines[1::2], strict=True))
    random.Random(seed).shuffle(pairs)
    return {" ".join(text.split()): form for text, form in pairs[:count]}


def paste(page: Page, base: str, texts: list[str]) -> None:
    page.goto(f"{base}/utterances/new/")
    page.fill("textarea[name=text]", "\n".join(texts))
    page.click("main button[type=submit]")
    page.wait_for_load_state("load")


def words_of(page: Page) -> str:
    """Return the utterance on the page, without the words of its chips."""
    text: str = page.evaluate(
        """() => {
          const text = document.querySelector(".label-text").cloneNode(true);
          text.querySelectorAll(".chip").forEach((chip) => {
            chip.replaceWith(chip.querySelector(".value").textContent);
          });
          return text.textContent;
        }"""
    )
    return text


def answer(page: Page, form: str) -> int:
    """Answer with ``form`` by keys. Returns the number of the candidate, 0 where it was written or is UNKNOWN."""
    values: list[str] = page.locator("[data-item] button[name=form]").evaluate_all(
        "buttons => buttons.map((button) => button.value)"
    )
    if form == "UNKNOWN":
        page.keyboard.press("u")
        return 0
    if form in values:
        page.keyboard.press(str(values.index(form) + 1))
        return values.index(form) + 1
    page.keyboard.press("e")
    page.wait_for_selector("[data-item] .cm-editor")
    page.get_by_role("textbox", name="Logical form").fill(form)
    page.keyboard.press("Control+Enter")
    return 0


def sit(page: Page, base: str, forms: dict[str, str], pause: float) -> list[tuple[int, float]]:
    """Label every utterance. Returns the candidate and the milliseconds of each."""
    page.goto(f"{base}/label/")
    page.wait_for_selector("[data-label-page][data-ready]")
    taken = []
    while page.wait_for_selector("[data-asks], [data-label-done]") and (
        item := page.query_selector("[data-item]")
    ):
        key = item.get_attribute("data-item")
        text = words_of(page)
        if text not in forms:
            page.keyboard.press("s")
            number = None
        time.sleep(pause)
        began = time.perf_counter()
        if text in forms:
            number = answer(page, forms[text])
        page.wait_for_function(
            "key => document.querySelector('[data-item]')?.dataset.item !== key", arg=key
        )
        if number is not None:
            taken.append((number, 1000 * (time.perf_counter() - began)))
    page.wait_for_selector("[data-label-done]")
    return taken


def report(taken: list[tuple[int, float]], seconds: float) -> None:
    numbers = [number for number, _ in taken]
    by_key = sorted(took for number, took in taken if number)
    print(f"{len(taken)} utterances in {seconds:.1f} s, {seconds / len(taken):.2f} s each")
    print(f"candidate 1 was right: {numbers.count(1)}; 2-9: {sum(n > 1 for n in numbers)}")
    print(f"written with e, or UNKNOWN: {numbers.count(0)}")
    print(f"key to next utterance: median {statistics.median(by_key):.0f} ms", end=", ")
    print(f"95 %: {by_key[int(0.95 * (len(by_key) - 1))]:.0f} ms, most {by_key[-1]:.0f} ms")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pairs", type=Path)
    parser.add_argument("--url", default="http://127.0.0.1:8000")
    parser.add_argument("--user", default="admin")
    parser.add_argument("--world", required=True)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--pause", type=float, default=0.0, help="seconds of looking before each key"
    )
    args = parser.parse_args()
    forms, base = read_pairs(args.pairs, args.count, args.seed), f"{args.url}/w/{args.world}"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_page()
        log_in(page, args.url, args.user, os.environ["GPSR_PASSWORD"])
        paste(page, base, list(forms))
        began = time.perf_counter()
        report(sit(page, base, forms, args.pause), time.perf_counter() - began)
        browser.close()


if __name__ == "__main__":
    main()
