"""A world from what people say: lines with marks on the left, what they propose on the right, stored by one button."""

from __future__ import annotations

from typing import Any

from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.labelling.storing_examples import NoExamples, store_examples
from annotations.language.induction import CATEGORY, propose, with_proposal
from annotations.language.texts import LanguageError, say_count
from annotations.models import Duty, World
from annotations.people.access import NOTHING, READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.rows.from_rows import ontology_of, ready_templates
from annotations.rows.known_world import known_world_of
from annotations.web.description.example_forms import MOST_TEXT, ExamplesForm, corrected
from annotations.web.description.proposal_presentation import shown
from annotations.web.editing.undo import say_with_undo
from annotations.web.forms import posted, sentence_of


@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="store examples")
def by_example(request: WorldRequest, world: World) -> HttpResponse:
    """Show the lines and what they propose; a POST stores it."""
    form = ExamplesForm(world, posted(request))
    if request.method == "POST" and form.is_valid():
        sent = form.cleaned_data
        try:
            stored = store_examples(
                world, sent["lines"], request.user, sent["task_category"] or CATEGORY, sent["once"]
            )
        except NoExamples as error:
            form.add_error("lines", error.message)
        except LanguageError as error:
            form.add_error("lines", sentence_of(error))
        else:
            if stored is not None:
                counts = {
                    "class": stored.classes,
                    "entity": stored.entities,
                    "predicate": stored.predicates,
                    "template": stored.templates,
                    "utterance": stored.utterances,
                }
                said = [say_count(number, noun) for noun, number in counts.items() if number]
                longer = say_count(stored.lengthened, "line") if stored.lengthened else ""
                sentence = f"Added {', '.join(said) or 'nothing'}." + (
                    f" {longer} of the grammar and the templates say more now." if longer else ""
                )
                values = {"world": world.name, "pk": stored.upload}
                say_with_undo(request, sentence, reverse("upload_undo", kwargs=values))
            return redirect("by_example", world=world.name)
    text = form["lines"].value() or ""
    context = {
        "form": form,
        "has_templates": ready_templates(world).exists(),
        **proposed(
            world,
            text if len(text) <= MOST_TEXT else "",
            form["task_category"].value() or "",
            request,
        ),
    }
    status = 422 if form.errors else 200
    return render(request, "annotations/description/by_example.html", context, status=status)


@world_view(Duty.ANNOTATE, WRITE, does=NOTHING)
def by_example_preview(request: WorldRequest, world: World) -> HttpResponse:
    """Show what the typed lines propose. A correction rewrites them first; they come back with the proposal."""
    form = ExamplesForm(world, request.POST)
    if form.is_valid():
        sent = form.cleaned_data
        context = proposed(world, sent["lines"], sent["task_category"], request)
    else:
        context = {"refused": " ".join(map(str, form.errors.get("lines", ())))}
    return render(request, "annotations/description/_proposal.html", context)


def proposed(world: World, text: str, category: str, request: WorldRequest) -> dict[str, Any]:
    """Return the context of a proposal: ``proposal`` as it is shown, ``problems`` of the lines.

    ``rewritten`` are the lines as a correction has rewritten them, ``refused`` why one was not made.
    """
    context: dict[str, Any] = {}
    try:
        known = known_world_of(world, category or CATEGORY)
    except LanguageError as error:
        return {"refused": f"The grammar of this world cannot be read: {sentence_of(error)}"}
    proposal = propose(text, known)
    try:
        ontology = with_proposal(ontology_of(world), proposal, known)
        rewritten = corrected(text, proposal, request.POST, ontology)
    except LanguageError as error:
        return {"refused": sentence_of(error), "proposal": shown(proposal, known)}
    if rewritten != text:
        proposal, context["rewritten"] = propose(rewritten, known), rewritten
    return {**context, "proposal": shown(proposal, known), "problems": proposal.problems}
