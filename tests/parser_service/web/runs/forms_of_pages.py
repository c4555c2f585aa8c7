"""A form as a browser has it: what it would send, and what is written beside each field."""

from __future__ import annotations

from collections import defaultdict
from html.parser import HTMLParser


class PageForm(HTMLParser):
    """The form for a run in the markup of a page.

    ``values`` are what a browser sends where nobody changes anything, ``faults`` the sentences in
    the same ``.field`` as a control; both are by the name of the control.
    """

    def __init__(self, markup: str):
        super().__init__()
        self.values: dict[str, str] = {}
        self.faults: dict[str, str] = defaultdict(str)
        self._field = ""
        self._is_fault = False
        self.feed(markup)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag == "div" and given.get("class") == "field":
            self._field = ""
        elif tag in ("input", "select") and "name" in given:
            self._field = given["name"] or ""
            if tag == "input" and given.get("type") != "checkbox":
                self.values[self._field] = given.get("value") or ""
            elif tag == "input" and "checked" in given:
                self.values[self._field] = "on"
        elif tag == "option" and ("selected" in given or self._field not in self.values):
            self.values[self._field] = given.get("value") or ""
        elif tag == "ul" and "errorlist" in (given.get("class") or ""):
            self._is_fault = True

    def handle_endtag(self, tag: str) -> None:
        if tag == "ul":
            self._is_fault = False

    def handle_data(self, data: str) -> None:
        if self._is_fault:
            self.faults[self._field] += data
