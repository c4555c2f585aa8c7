"""The keys of all pages: one key has one meaning everywhere. Pages, the dialog that lists them and the scripts read
this table alone."""

from __future__ import annotations

from dataclasses import dataclass

ARROWS = {"ArrowLeft": "←", "ArrowRight": "→", "ArrowUp": "↑", "ArrowDown": "↓"}


@dataclass(frozen=True, slots=True)
class PageKey:
    """Each of ``keys`` does ``action``, which templates and scripts know by its name."""

    action: str
    keys: tuple[str, ...]
    meaning: str

    @property
    def presses(self) -> tuple[tuple[str, ...], ...]:
        """The keys as they are written on a keyboard: pressed together, where a ``+`` joins them."""
        return tuple(tuple(ARROWS.get(part, part) for part in key.split("+")) for key in self.keys)


def _key(action: str, keys: str, meaning: str) -> PageKey:
    return PageKey(action, tuple(keys.split()), meaning)


EVERYWHERE = (
    _key("search", "/", "search"),
    _key("next", "j", "next row, or next example"),
    _key("previous", "k", "previous row, or previous example"),
    _key("open", "Enter", "open the row"),
    _key("next_page", "n", "next page"),
    _key("previous_page", "p", "previous page"),
    _key("copy", "c", "copy the form of the row"),
    _key("tick", "x", "tick the row, or take the tick away"),
    _key("undo", "z", "take your last answer, decision or change back"),
    _key("keys", "?", "show these keys"),
)

OF_PAGES = (
    _key("digit", "1 2 3 4 5 6 7 8 9 0 - =", "take what has this digit"),
    _key("accept", "a", "accept what is proposed or was written; keep a label in doubt"),
    _key("reject", "r", "reject it; exclude a label in doubt from new splits"),
    _key("unknown", "u", "UNKNOWN: no form says this"),
    _key("skip", "s", "skip"),
    _key("edit", "e", "write another form, or edit the text and see what each run answers then"),
    _key("mend", "m", "mend a name or a typing error"),
    _key("dispute", "d", "dispute the label: it may be wrong"),
    _key("note", "i", "write a note or a reason"),
    _key("guidelines", "g", "show the guidelines"),
    _key("candidates", "b", "show the candidates"),
    _key("tree", "t", "show the difference as a tree"),
    _key("all", "v", "show all of a long utterance and its forms"),
    _key("filters", "f", "open the filters"),
    _key("differ", "w", "only where the runs differ, or everywhere again"),
    _key("beside", "o", "choose another run to show beside them"),
    _key("queue", "q", "open the work queue, once something was sent there"),
    _key("left", "h ArrowLeft", "answer of the run before"),
    _key("right", "l ArrowRight", "answer of the run after"),
)

# Combinations, which belong to what somebody writes; the editor has them by itself.
IN_EDITORS = (
    _key("save", "Ctrl+Enter", "in an editor: save"),
    _key(
        "save_and_next",
        "Ctrl+Shift+Enter",
        "in a template: save, and go to the next command without a form",
    ),
    _key("repair", "Ctrl+.", "in an editor: take the first repair"),
    _key("problem", "F8", "in an editor: next problem, with its repairs"),
    _key("select", "Alt+ArrowUp Alt+ArrowDown", "in an editor: select more, select less"),
    _key("format", "Alt+Shift+F", "in an editor: put into the usual layout"),
    _key("lambda", "\\", "in a logical form: λ"),
)

KEYS = {key.action: key for key in (*EVERYWHERE, *OF_PAGES, *IN_EDITORS)}


def keys_for(*actions: str) -> tuple[PageKey, ...]:
    """Return the keys of a page, for the dialog that lists them. Raises KeyError for an action that has none."""
    return tuple(KEYS[action] for action in actions)


def actions_by_key() -> dict[str, str]:
    """Return what each key does, by its name, for the scripts."""
    return {key: each.action for each in (*EVERYWHERE, *OF_PAGES) for key in each.keys}
