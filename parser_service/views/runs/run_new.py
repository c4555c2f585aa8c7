"""Starting runs: one form for every parser, for admins."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render

from annotations.forms import posted
from annotations.models import Duty, World
from annotations.people.access import READ_AND_WRITE, world_view
from parser_service.models import TrainingRun
from parser_service.parsers.registry import PARSERS
from parser_service.results.accuracy import seeds_url
from parser_service.runs.requests.starting import start_runs
from parser_service.views.runs.parser_picker import parser_groups
from parser_service.views.runs.run_choices import RunChoices, choices_in, query_of
from parser_service.views.runs.run_forms import RunForm


@world_view(Duty.MANAGE, READ_AND_WRITE)
def run_new(request: HttpRequest, world: World) -> HttpResponse:
    """Show the form that starts runs, and start them. If another parser than the one shown was chosen,
    its form opens instead."""
    choices = choices_in(request.GET, world)
    wanted = request.POST.get("parser", choices.parser)
    if wanted in PARSERS and (wanted != choices.parser or "choose" in request.POST):
        return redirect(f"{request.path}?{query_of(request.POST, wanted, choices.parser)}")
    form = RunForm(world, choices.parser, posted(request), initial=choices.initial)
    if request.method == "POST" and form.is_valid():
        started = start(request, world, form)
        if len(started) == 1:
            return redirect("run", world=world.name, pk=started[0].pk)
        if started:
            return redirect(seeds_url(world, started[0]))
    return render(request, "parser_service/run_new.html", context_of(world, form, choices))


def context_of(world: World, form: RunForm, choices: RunChoices) -> dict[str, object]:
    """Return what the page shows besides the form."""
    splits = world.splits.all()
    key = str(form["split"].value() or "")
    chosen = splits.filter(pk=key).first() if key.isdecimal() and len(key) < 19 else None
    return {
        "form": form,
        "chosen": choices.parser,
        "entry": PARSERS[choices.parser],
        "note": choices.note,
        "groups": parser_groups(world, chosen or splits.first()),
        "has_splits": splits.exists(),
    }


def start(request: HttpRequest, world: World, form: RunForm) -> list[TrainingRun]:
    """Request the runs of the form, one per seed, and return them, whether new or already there. Where
    they are refused, return none and put the reason into the form."""
    try:
        answers = start_runs(world, request.user, **form.asked)
    except ValueError as error:
        form.add_error(None, str(error))
        return []
    if told := in_words(answers):
        messages.info(request, told)
    return [run for run, _ in answers]


def in_words(answers: list[tuple[TrainingRun, bool]]) -> str:
    """Say which runs are new and which were there; empty for one new run, whose page opens anyway."""
    count, new = len(answers), sum(is_new for _, is_new in answers)
    if count == 1:
        return "" if new else "This has been trained already; here is that run."
    if not new:
        return f"All {count} seeds have been asked for already; here are their runs."
    first, last = answers[0][0].seed, answers[-1][0].seed
    started = f"Started {new} run{'s' if new > 1 else ''}, seeds {first} to {last}"
    if new == count:
        return f"{started}."
    return f"{started}; {count - new} {'was' if count - new == 1 else 'were'} there already."
