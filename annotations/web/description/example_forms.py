"""The form of the page By example, and the corrections that rewrite its lines."""

from __future__ import annotations

import re
from typing import Any

from django import forms
from django.http import QueryDict

from annotations.editing.once_keys import new_key
from annotations.language.corpus import require_predicate
from annotations.language.forms import require_token
from annotations.language.induction import (
    CATEGORY,
    EXAMPLE,
    MOST_CHARACTERS,
    MOST_LINES,
    Proposal,
    marked,
    with_class_named,
    with_english,
    with_predicate_named,
)
from annotations.language.world import Ontology
from annotations.models import TaskCategory, World
from annotations.web.forms import choice_field

MOST_TEXT = MOST_LINES * (MOST_CHARACTERS + 2)


class ExamplesForm(forms.Form):
    """Commands as people say them, a line each, and the task category that their templates go to."""

    lines = forms.CharField(
        label="What people say",
        required=False,
        strip=False,
        max_length=MOST_TEXT,
        widget=forms.Textarea(attrs={"rows": 14, "placeholder": EXAMPLE, "spellcheck": "false"}),
        help_text="One command a line. Select what may change and press [ to mark it.",
    )
    task_category = forms.ChoiceField(required=False)
    once = forms.CharField(widget=forms.HiddenInput, required=False, max_length=60, initial=new_key)

    def __init__(self, world: World, *args: Any, **options: Any):
        super().__init__(*args, **options)
        stored = TaskCategory.objects.filter(grammar__world=world).values_list("name", flat=True)
        names = dict.fromkeys((CATEGORY, *stored))
        choice_field(self, "task_category").choices = [(name, name) for name in names]
        if len(names) == 1:
            self.fields["task_category"].widget = forms.HiddenInput()
        self.fields["task_category"].initial = CATEGORY


def corrected(text: str, proposal: Proposal, sent: QueryDict, ontology: Ontology) -> str:
    """Return the lines as a correction of their proposal rewrites them; as they are without one.

    ``change`` is ``class`` or ``predicate``, which give what is called ``of`` the name ``name``; ``english``, which
    gives the predicate ``of`` the English ``gloss``; or ``add``, which appends each ``line``, what was ``said`` with
    the entities of ``ontology`` marked, and all offers of the kind ``offers``. Raises LanguageError for what can be
    no name, and for English that is too long.
    """
    change, old = sent.get("change", ""), sent.getlist("of")
    name = re.sub(r"\W+", "_", sent.get("name", "").strip()).strip("_")
    if change == "class":
        require_token(name := name.lower())
        for token in old:
            text = with_class_named(text, proposal, token, name)
    elif change == "predicate":
        require_predicate(name)
        for predicate in old:
            text = with_predicate_named(text, proposal, predicate, name)
    elif change == "english":
        for predicate in old:
            text = with_english(text, predicate, sent.get("gloss", ""))
    elif change == "add":
        kind = sent.get("offers", "")
        lines = [
            *sent.getlist("line"),
            *(marked(each, ontology, proposal) for each in sent.getlist("said")),
            *(each.line for each in proposal.offers if each.kind == kind),
        ]
        text = "\n".join(filter(None, [text.rstrip(), *(" ".join(each.split()) for each in lines)]))
    return text
