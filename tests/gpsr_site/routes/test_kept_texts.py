"""What somebody types into a form is kept as a draft, wherever a form has room for a sentence."""

from __future__ import annotations

from dataclasses import dataclass, field
from html.parser import HTMLParser

from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import API_ROUTES
from tests.gpsr_site.routes.policy import POLICY, YES
from tests.gpsr_site.routes.rules import undone

READABLE = sorted(
    {rule.name for rule in POLICY if (rule.method, rule.admin) == ("get", YES)} - set(API_ROUTES)
)
LONG = 200  # characters: a field that takes as many is for sentences
# Forms with such a field that keep nothing, and why.
WITHOUT_DRAFT = {
    "upload": "what it holds came with a file or from a form that kept it",
    "playground": "the address holds the text",
    "joint_plan": "the address holds the texts",
    "dialogues": "one command, which begins a dialogue",
    "dialogue": "one answer in a conversation, which goes on meanwhile",
    "campaign_place": "contributors have no account: the page of a campaign keeps it for its window",
    "import": "files are chosen, not typed",
}


@dataclass
class Forms(HTMLParser):
    """The forms of a page that are posted and have room for a sentence: their attributes."""

    found: list[dict[str, str | None]] = field(default_factory=list)
    current: dict[str, str | None] | None = None

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = dict(attrs)
        if tag == "form":
            self.current = values if values.get("method") == "post" else None
        is_long = int(values.get("maxlength") or 0) >= LONG and values.get("type") == "text"
        takes_sentences = tag == "textarea" or (tag == "input" and is_long)
        if self.current is not None and takes_sentences and self.current not in self.found:
            self.found.append(self.current)

    def handle_endtag(self, tag: str) -> None:
        if tag == "form":
            self.current = None


def forms_of(text: str) -> list[dict[str, str | None]]:
    forms = Forms()
    forms.feed(text)
    return forms.found


def test_a_form_with_room_for_a_sentence_keeps_what_is_typed(sample, client_as, subtests):
    for name in READABLE:
        with subtests.test(name), undone():
            answer = client_as("superuser").get(address(name, sample), follow=True)
            if "text/html" in answer["Content-Type"]:
                check_forms(name, answer, sample)


def check_forms(name: str, answer, sample) -> None:
    for form in forms_of(answer.getvalue().decode()):
        if name not in WITHOUT_DRAFT:
            assert form.get("data-draft"), form
        if "data-draft" in form:
            assert (form["data-draft"] or "").startswith(f"{sample.world.pk}-")
            assert form["data-draft-of"] and form["data-draft-about"]
