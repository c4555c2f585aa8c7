"""Template tags and filters: heads of pages, forms, commands, figures."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from typing import Any

from django import template
from django.db.models import QuerySet
from django.template.loader import render_to_string
from django.urls import reverse
from django.utils.html import format_html, format_html_join
from django.utils.safestring import SafeString, mark_safe

from annotations.language.corpus import CLASS_OF_ATTRIBUTE
from annotations.language.forms import Change, predicates
from annotations.language.texts import Position, article
from annotations.models import Predicate, World
from annotations.models.editing import LONGEST_ABOUT, NEW
from annotations.models.splits import criterion_choices
from annotations.showing import figures
from annotations.showing.form_presentation import (
    answer_difference,
    answer_pieces,
    form_of,
    gloss_of,
    merge_words,
    merged_difference,
    pieces_of,
    shown,
    tree_of,
    wildcard_class,
)
from annotations.showing.markdown import rendered
from annotations.showing.own_entities import OwnEntities

register = template.Library()
for written in (
    figures.percent,
    figures.figure,
    figures.decimals,
    figures.signed,
    figures.p_value,
    figures.duration,
    figures.rough_duration,
    figures.ago,
):
    register.filter(written)
register.filter("as_markdown", rendered)
register.filter("article", article)

PLACE = ("source", "line", "column")
PATTERN_TOKEN = re.compile(r"(\$\w+|\{[^{}]*\})")


@register.simple_block_tag(takes_context=True, end_name="end_page_title")
def page_title(context: Any, content: str) -> str:
    """Keep ``content`` as ``page_title``, the one name of a page: title, heading and last step of the breadcrumb."""
    context["page_title"] = mark_safe(content.strip())  # rendered, so escaped already
    return ""


@register.simple_block_tag(takes_context=True, end_name="end_page_head")
def page_head(context: Any, content: str, title: str = "", aside: str = "") -> str:
    """Render the head of a page (see ``_page_head.html``) with ``content`` as its sentence; an ``actions`` in it holds
    the buttons.

    ``title`` is for a name that is shown with marks, such as the chips of a command.
    """
    # The content was rendered by the template, so it is escaped already.
    values = {
        "title": title,
        "aside": aside,
        "about": mark_safe(content.strip()),
        "actions": context.render_context.get("actions", ""),
    }
    return _render_inside(context, "_page_head.html", values)


@register.simple_block_tag(takes_context=True, end_name="end_actions")
def actions(context: Any, content: str) -> str:
    """Keep what may be done on a page for the ``page_head`` around it."""
    context.render_context["actions"] = mark_safe(content.strip())
    return ""


@register.simple_block_tag(takes_context=True, end_name="end_filtered_list")
def filtered_list(context: Any, content: str, noun: str, notation: bool = False) -> str:
    """Render the ``listing`` of a page (see ``_list.html``) with ``content`` as its table."""
    values = {"noun": noun, "notation": notation, "table": mark_safe(content.strip())}
    return _render_inside(context, "_list.html", values)


def _render_inside(context: Any, name: str, values: dict[str, Any]) -> str:
    """Render a template with the context of the page and ``values``."""
    with context.push(**values):
        html: str = context.template.engine.get_template(name).render(context)
        return html


@register.simple_block_tag(end_name="end_empty_state")
def empty_state(content: str, url: str = "", action: str = "") -> str:
    """Render what stands in the place of an empty list: a sentence and the button that fills it."""
    values = {"sentence": mark_safe(content.strip()), "action_url": url, "action": action}
    return render_to_string("_empty.html", values)


@register.simple_tag(takes_context=True)
def draft_attributes(
    context: Any,
    kind: str,
    row: Any = None,
    name: str = "",
    about: str = "",
    page: str = "",
    at: object = "",
) -> SafeString:
    """Return the attributes of a form whose text is kept on the server as a draft while it is typed.

    ``kind`` is a name in ``annotations.rows.row_kinds``; without a ``row`` the form makes a new one.
    ``name``, a short slug, tells apart the forms about one row, and those that make new rows for different reasons.
    ``about``, ``page`` and ``at`` are as in ``browser_draft``.
    """
    key = str(row.pk) if row else NEW
    world, subject = context["world"], f"{key}-{name}" if name else key
    path = reverse("draft", kwargs={"world": world.name, "kind": kind, "subject": subject})
    noun = about or kind.replace("_", " ").capitalize()
    attributes = browser_draft(
        context,
        *(kind, subject),
        about=noun if row else f"New {noun.lower()}",
        of=row,
        page=page,
        at=at,
    )
    return format_html('{} data-draft-url="{}"', attributes, path)


@register.simple_tag(takes_context=True)
def browser_draft(
    context: Any, *name: object, about: str, of: object = None, page: str = "", at: object = ""
) -> SafeString:
    """Return the attributes of a form whose text is kept in this browser as a draft while it is typed.

    The parts of ``name`` tell it from other forms of its world. The list of drafts says ``about``, and ``of`` what.
    ``page`` is the address of the form where it is not that of its page; ``at`` is written behind it.
    """
    called = f"{about}: {of}" if of else about
    attributes = format_html(
        'data-draft="{}-{}" data-draft-of="{}" data-draft-about="{}"',
        context["world"].pk,
        "-".join(map(str, name)),
        context["request"].user.pk,
        called[:LONGEST_ABOUT],
    )
    if not page:
        return attributes
    start = reverse("world", kwargs={"world": context["world"].name})
    return format_html('{} data-draft-page="{}{}"', attributes, page.removeprefix(start), at)


@register.inclusion_tag("_logical_form.html", takes_context=True)
def logical_form(
    context: Any,
    text: str,
    gloss: bool = False,
    tools: bool = False,
    url: str = "",
    tree: bool = False,
    own: OwnEntities | None = None,
) -> dict[str, Any]:
    """Show a form in the notation that the page shows.

    With ``gloss`` its English sentence stands beneath, linked to ``url`` where one is given, and with the entities of
    the utterance that it is for, ``own``; with ``tree`` the form as a tree.
    """
    form = shown(text)
    if gloss:
        form = replace(form, gloss=gloss_of_form(context, text, own))
    return {"form": form, "tools": tools, "url": url, "tree": tree}


@register.simple_tag(takes_context=True)
def gloss_of_form(context: Any, text: str, own: OwnEntities | None = None) -> str:
    """Write a form as an English sentence, with the entities of the utterance that it is for; empty for what is not a
    form."""
    if own:
        return own.english(text)
    form = form_of(text)
    return gloss_of(context["world"], form) if form else ""


@register.simple_tag(takes_context=True)
def predicates_in(context: Any, text: str) -> QuerySet[Predicate]:
    """Return the declared predicates that a form uses."""
    form = form_of(text)
    world: World = context["world"]
    return world.predicates.filter(name__in=predicates(form) if form else ())


@register.filter
def class_named_by(attribute: str) -> str:
    """Return the class of the entity that an attribute names, such as a room; empty where it names none."""
    return CLASS_OF_ATTRIBUTE.get(attribute.lower(), "")


@register.simple_tag
def form_beside(first: str, other: str) -> SafeString:
    """Show ``other`` with what it has beyond ``first`` and what it lacks marked; a button may hold it."""
    pieces = merged_difference(first, other)
    marked = format_html_join("", "{}", ((_mark_piece(*piece),) for piece in pieces))
    return format_html('<span class="lf"><code>{}</code></span>', marked)


@register.simple_tag
def template_notation(text: str) -> str:
    """Write a form as people edit it; empty for what is not a form."""
    return shown(text).template


@register.filter
def chips(text: str) -> SafeString:
    """Show a command with its class tokens as chips."""
    chip = '<span class="chip" data-class="{0}">{0}</span>'
    shown = (
        format_html(chip, piece.entity_class) if piece.entity_class else piece.text
        for piece in pieces_of(text)
    )
    return format_html_join("", "{}", ((piece,) for piece in shown))


@register.filter
def grounded(utterance: Any) -> SafeString:
    """Show the text of an utterance with the words that name an entity marked by its class."""
    pieces, end = [], 0
    for start, stop, entity_class, entity in utterance.spans:
        name = format_html(
            '<span class="chip" data-class="{0}" title="{2}"><span class="value">{1}</span>{0}</span>',
            entity_class,
            utterance.text[start:stop],
            entity,
        )
        pieces += [(utterance.text[end:start],), (name,)]
        end = stop
    return format_html_join("", "{}", [*pieces, (utterance.text[end:],)])


@register.simple_tag
def command(text: str) -> SafeString:
    """Show a command with its class tokens as chips."""
    return chips(text)


@register.simple_tag
def pattern(text: str) -> SafeString:
    """Show a pattern or an expansion with its nonterminals and wildcards marked."""
    return format_html_join("", "{}", ((_mark(token),) for token in PATTERN_TOKEN.split(text)))


@register.simple_tag(takes_context=True)
def linked_pattern(context: Any, text: str) -> SafeString:
    """Show a pattern as ``pattern`` does, each nonterminal a link to its productions."""
    grammar = reverse("grammar", kwargs={"world": context["world"].name})
    tokens = PATTERN_TOKEN.split(text)
    return format_html_join("", "{}", ((_mark(token, grammar),) for token in tokens))


def _mark(token: str, grammar_url: str = "") -> str:
    if token.startswith("$") and grammar_url:
        link = '<a class="lf-nonterminal" href="{}?nonterminal={}">{}</a>'
        return format_html(link, grammar_url, token[1:], token)
    if token.startswith("$"):
        return format_html('<span class="lf-nonterminal">{}</span>', token)
    if token.startswith("{"):
        hue = wildcard_class(token)
        return format_html('<span class="lf-slot" data-class="{}">{}</span>', hue, token)
    return token


@register.simple_tag
def expected_form(expected: str, predicted: str) -> SafeString:
    """Show the label, with what the prediction lacks marked, whatever the order of conjuncts."""
    return _form_with_marks(answer_pieces(expected, predicted)[0])


@register.simple_tag
def predicted_form(expected: str, predicted: str) -> SafeString:
    """Show the predicted form, with what it has beyond the annotated one marked; its conjuncts stand in the
    order of those of the label."""
    return _form_with_marks(answer_pieces(expected, predicted)[1])


@register.simple_tag
def difference_tree(expected: str, predicted: str) -> SafeString:
    """Show both forms as one tree, with what was added, removed and changed marked; nothing for no form."""
    compared = answer_difference(expected, predicted)
    if compared is None:
        return mark_safe("")
    nodes = json.dumps(tree_of(compared))
    return format_html('<div class="tree" data-tree data-tree-nodes="{}"></div>', nodes)


# The element that marks a piece of a form; one without a change stands as it is.
MARKS = {Change.ADDED: "ins", Change.REMOVED: "del", Change.CHANGED: "mark"}


@register.simple_tag
def marked_text(pieces: list[tuple[str, str]]) -> SafeString:
    """Show a text with what was added and removed marked (``annotations.showing.form_presentation.compare``)."""
    marked = format_html_join("", "{}", ((_mark_piece(*piece),) for piece in pieces))
    return format_html('<figure class="lf"><code>{}</code></figure>', marked)


@register.simple_tag
def edited_text(old: str, new: str) -> SafeString:
    """Show a command with the words that it has beyond ``old`` marked, and those that it lacks struck out."""
    pieces = ((change, chips(text)) for change, text in merge_words(old, new))
    marked = format_html_join("", "{}", ((_mark_piece(*piece),) for piece in pieces))
    return format_html('<span class="edited">{}</span>', marked)


def _form_with_marks(pieces: list[tuple[str, str]]) -> SafeString:
    marked = format_html_join("", "{}", ((_mark_piece(*piece),) for piece in pieces))
    return format_html('<figure class="lf" data-form><code>{}</code></figure>', marked)


def _mark_piece(change: str, text: str) -> str:
    element = MARKS.get(Change(change))
    return format_html("<{0}>{1}</{0}>", element, text) if element else text


@register.filter
def criterion_label(criterion: str) -> str:
    """Say what a split keeps apart inside a sentence: ``logical form`` for ``logical_form``."""
    return dict(criterion_choices())[criterion].lower()


@register.filter
def place(at: Any) -> str:
    """Write a place as ``source:line:column``; nothing for a problem of no file.

    ``at`` is a position, or what has a position's parts as keys or attributes.
    """
    parts = [at[name] if isinstance(at, dict) else getattr(at, name) for name in PLACE]
    return str(Position(*parts))


@register.inclusion_tag("annotations/description/_guidelines_panel.html", takes_context=True)
def guidelines_panel(context: Any) -> dict[str, Any]:
    """Show the guidelines of the world, folded, for pages on which people label."""
    world = context["world"]
    text = world.guidelines.values_list("text", flat=True).first() or ""
    return {"world": world, "can": context["can"], "guidelines": rendered(text)}
