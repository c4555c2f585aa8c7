"""Does what a tutorial of the documents says, in a browser: the document is the script.

A sentence is an instruction where it says one of these. Others are for people alone.

    choose **a link or an option**, then **another**, press **a button**, open the list of worlds
    write `a text` into **a field**, write these lines into **a field** with a block behind it
    beside `a thing` write `its kind`
    you see `a text`

A picture stands where the page looks like it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from textwrap import dedent
from time import monotonic

from playwright.sync_api import Locator, Page, expect

from tests.browser.arriving import arrive_at, wait_for_swap

INSTRUCTION = re.compile(
    r"""
    (?P<worlds>open\s+the\s+list\s+of\s+worlds)
    | (?:choose|press|then|and)\s+\*\*(?P<control>.+?)\*\*
    | write\s+these\s+lines\s+into\s+\*\*(?P<area>.+?)\*\*:\n\n[ ]*```text\n(?P<lines>.*?)\n[ ]*```
    | write\s+`(?P<text>[^`]+)`\s+into\s+\*\*(?P<field>.+?)\*\*
    | beside\s+`(?P<thing>[^`]+)`\s+write\s+`(?P<kind>[^`]+)`
    | you\s+see\s+`(?P<seen>[^`]+)`
    | !\[[^]]*\]\(\.\./images/(?P<picture>[\w-]+)\.png\)
    """,
    re.VERBOSE | re.DOTALL | re.IGNORECASE,
)
TYPING_MILLISECONDS = 700  # as long as a page waits for the next key


@dataclass
class Effort:
    """What a person does. Lines that are pasted are one key."""

    clicks: int = 0
    keys: int = 0
    seconds: float = 0.0


def instructions(document: Path, heading: str = "") -> Iterator[dict[str, str]]:
    """Yield the groups of each instruction of a document that are there; of the part below ``heading`` alone."""
    text = document.read_text(encoding="utf-8")
    if heading:
        text = text.partition(f"\n## {heading}\n")[2].partition("\n## ")[0]
    for match in INSTRUCTION.finditer(text):
        groups = {name: value for name, value in match.groupdict().items() if value}
        yield {
            name: dedent(value) if name == "lines" else " ".join(value.split())
            for name, value in groups.items()
        }


@dataclass
class Follower:
    """Somebody who follows a document on a page.

    ``before_each`` is called before each instruction, ``take`` with the name of each picture.
    """

    page: Page
    before_each: Callable[[], object] = lambda: None
    take: Callable[[str], object] = lambda name: None

    def follow(self, document: Path, heading: str = "") -> Effort:
        self.effort = Effort()
        begun = monotonic()
        for each in instructions(document, heading):
            self.before_each()
            self._do(each)
            wait_for_swap(self.page)
        self.effort.seconds = monotonic() - begun
        return self.effort

    def _do(self, said: dict[str, str]) -> None:
        match said:
            case {"worlds": _}:
                self._click(self.page.locator("#rail summary"))
            case {"control": name}:
                self._click(self._control(name))
            case {"area": name, "lines": lines}:
                self._write(name, lines, keys=1)
            case {"field": name, "text": text}:
                self._write(name, text, keys=len(text))
            case {"thing": thing, "kind": kind}:
                self._write(f"The kind of {thing}", kind, keys=len(kind) + 1)
                self.page.keyboard.press("Enter")
            case {"seen": text}:
                expect(self.page.locator("main")).to_contain_text(text)
            case {"picture": name}:
                self.take(name)

    def _control(self, name: str) -> Locator:
        page = self.page
        # A link of the rail has a count behind its name.
        with_count = re.compile(rf"^{re.escape(name)}( [\d,]+)?$")
        named = page.get_by_role("link", name=with_count)
        named = named.or_(page.get_by_role("button", name=name, exact=True))
        return (
            named.or_(page.locator("label").get_by_text(name, exact=True))
            .locator("visible=true")
            .first
        )

    def _click(self, target: Locator) -> None:
        arrive_at(self.page, target)
        target.click()
        self.effort.clicks += 1

    def _write(self, name: str, text: str, keys: int) -> None:
        field = self.page.get_by_role("textbox", name=name, exact=True)
        choice = self.page.get_by_role("combobox", name=name, exact=True)
        arrive_at(self.page, field.or_(choice).first)
        if choice.count():
            choice.select_option(label=text)
        else:
            field.fill(text)
        self.effort.clicks += 1
        self.effort.keys += keys
        self.page.wait_for_timeout(TYPING_MILLISECONDS)
