"""The semantic templates."""

from __future__ import annotations

from annotations.web.description.template_forms import TemplateForm
from annotations.web.editing.nouns import Noun


class TemplateNoun(Noun):
    """Templates are edited with their commands and what a change would do, on pages of their own."""

    form = TemplateForm


TEMPLATES = TemplateNoun()
