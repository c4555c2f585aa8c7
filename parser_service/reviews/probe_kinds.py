"""The kinds of probes, and what pages call them."""

from __future__ import annotations

from parser_service.analysis.edit import EditKind
from parser_service.analysis.probe_texts import ProbeKind

REMOVAL = "removal"

# In the order of pages.
PROBE_KINDS = {
    ProbeKind.PAPER: "texts of the paper",
    ProbeKind.EMPTY: "empty texts",
    ProbeKind.SHUFFLED: "shuffled words",
    ProbeKind.TRUNCATED: "beginnings",
    ProbeKind.UNRELATED: "no commands",
    EditKind.ENTITY: "another entity of the class",
    EditKind.POLITENESS: "politeness",
    EditKind.ARTICLE: "article",
    EditKind.SPELLING: "spelling error",
    EditKind.SYNONYM: "synonym",
    EditKind.RECIPIENT: "another recipient",
    EditKind.PLACE: "another kind of place",
    EditKind.CLASS: "another class of thing",
    REMOVAL: "one word less",
}
