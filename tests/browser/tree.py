"""What an assistive program is told of a page: faults in Chromium's accessibility tree."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from playwright.sync_api import CDPSession, Page

from tests.browser.faults import Faults

# What a button does: itself without its looks and its words, and where its form goes, with what.
ACTION = """function () {
  const button = this.closest("button, summary, [role=button], input") ?? this;
  const looks = ["class", "id", "title", "aria-label", "aria-describedby", "aria-controls", "style"];
  const own = [...button.attributes].filter(({ name }) => !looks.includes(name));
  const form = button.form;
  const sent = form ? [...new FormData(form)].filter(([name]) => name !== "csrfmiddlewaretoken") : [];
  return JSON.stringify([own.map(({ name, value }) => [name, value]), form?.action, sent.map(String)]);
}"""


# What is read by what it holds: the target of the skip link, and the rows that j and k walk.
READ_BY_CONTENT = {"RootWebArea", "main", "row"}
# What only scrolls: CodeMirror's, around the text box that has the name, and code in documents.
SCROLLER = ".cm-scroller, pre"


@dataclass(frozen=True, slots=True)
class Node:
    """One node of the tree that is not ignored; ``level`` is that of a heading, else 0."""

    role: str
    name: str
    is_focusable: bool
    level: int
    dom_node: int

    @property
    def is_nameless(self) -> bool:
        return self.is_focusable and self.role not in READ_BY_CONTENT and not self.name


def nodes(session: CDPSession) -> Iterator[Node]:
    """Yield the tree of the page in the order in which it is read."""
    listed = {each["nodeId"]: each for each in session.send("Accessibility.getFullAXTree")["nodes"]}
    waiting = [next(iter(listed.values()))]
    while waiting:
        each = waiting.pop()
        waiting += [listed[key] for key in reversed(each.get("childIds", ())) if key in listed]
        if not each["ignored"]:
            yield _node(each)


def _node(told: dict[str, Any]) -> Node:
    properties = {item["name"]: item["value"].get("value") for item in told.get("properties", ())}
    role = str(told["role"]["value"])
    return Node(
        role,
        str(told.get("name", {}).get("value", "")).strip(),
        bool(properties.get("focusable")),
        int(properties.get("level", 0)) if role == "heading" else 0,
        told.get("backendDOMNodeId", 0),
    )


def tree_faults(page: Page) -> Faults:
    """Return what has the focus and no name, buttons of one name that do different things, and headings
    that leave out a level."""
    session = page.context.new_cdp_session(page)
    tree = list(nodes(session))
    faults = {
        "focusable without a name": list(_nameless(session, tree)),
        "buttons of one name": list(_ambiguous(session, tree)),
        "levels left out": list(_skips([each for each in tree if each.level])),
    }
    session.detach()
    return faults


def _nameless(session: CDPSession, tree: list[Node]) -> Iterator[str]:
    shown = (
        f"function () {{ return this.matches('{SCROLLER}') ? '' : this.outerHTML.slice(0, 160) }}"
    )
    for each in tree:
        if each.is_nameless and (element := _ask(session, each, shown)):
            yield element


def _ambiguous(session: CDPSession, tree: list[Node]) -> Iterator[str]:
    named: dict[str, list[Node]] = defaultdict(list)
    for each in tree:
        if each.role == "button" and each.name:
            named[each.name].append(each)
    for name, buttons in named.items():
        if len(buttons) > 1:
            actions = {_ask(session, each, ACTION) for each in buttons}
            if len(actions) > 1:
                yield f"{name}: {sorted(actions)}"


def _skips(headings: list[Node]) -> Iterator[str]:
    before = 1  # a dialog, whose title is of level 2, hides the page behind it
    for each in headings:
        if each.level > before + 1:
            yield f"{each.name} has level {each.level} after level {before}"
        before = each.level


def _ask(session: CDPSession, node: Node, function: str) -> str:
    """Return what ``function`` says with the element of ``node`` as its ``this``."""
    resolved = session.send("DOM.resolveNode", {"backendNodeId": node.dom_node})
    asked = {"objectId": resolved["object"]["objectId"], "functionDeclaration": function}
    return str(session.send("Runtime.callFunctionOn", asked)["result"].get("value", ""))
