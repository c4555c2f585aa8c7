"""Starting runs, for admins: one form for every parser, which opens with the choices in its address."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from statistics import median
from typing import Any

from django.contrib import messages
from django.http import HttpResponse, QueryDict
from django.shortcuts import get_object_or_404, redirect, render
from django.utils.http import urlencode
from django.views.decorators.cache import never_cache

from annotations.language.corpus import KNOWN
from annotations.language.texts import Refusal
from annotations.models import Duty, Job, Split, World
from annotations.models.background import Status
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.people.allowances import may_take_long
from annotations.showing.paging import number_in
from annotations.web.forms import posted
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.evaluations import ShownScore, shown_scores
from parser_service.parsers.conditions import SOURCE_WORDS, SOURCES, written_sources
from parser_service.parsers.pretrained_files import Gap
from parser_service.parsers.recommendation import Expectation, expectation_of
from parser_service.parsers.registry import RegistryEntry, config_fields, parsers
from parser_service.results.accuracy_tables import seeds_url
from parser_service.runs.recommended import (
    Advice,
    SplitContents,
    advise,
    train_sources,
    usual_split,
)
from parser_service.runs.retraining import retrainable
from parser_service.runs.starting import start_again, start_runs
from parser_service.runs.training_today import start_today
from parser_service.web.runs.run_forms import GENERAL, PREFIX, RunForm

MOST_RUNS = 200  # the newest that times are taken from


@world_view(Duty.MANAGE, READ_AND_WRITE, does="start a run")
def run_new(request: WorldRequest, world: World) -> HttpResponse:
    """Show the form that starts runs, and start them. If another parser than the one shown was chosen,
    its form opens instead."""
    choices = choices_in(request.GET, world)
    wanted = request.POST.get("parser", choices.parser)
    if wanted in parsers() and (wanted != choices.parser or "choose" in request.POST):
        return redirect(f"{request.path}?{query_of(request.POST, wanted, choices.parser)}")
    form = RunForm(world, choices.parser, posted(request), initial=choices.initial)
    if request.method == "POST" and form.is_valid():
        started = start(request, world, form)
        if len(started) == 1:
            return redirect("run", world=world.name, pk=started[0].pk)
        if started:
            return redirect(seeds_url(world, started[0]))
    return render(request, "parser_service/runs/run_new.html", context_of(world, form, choices))


def context_of(world: World, form: RunForm, choices: RunChoices) -> dict[str, object]:
    """Return what the page shows besides the form."""
    key = number_in(str(form["split"].value() or ""))
    is_other = key and (choices.split is None or key != choices.split.pk)
    chosen = (world.splits.filter(pk=key).first() if is_other else None) or choices.split
    advice = choices.advice if chosen == choices.split else advise(world, chosen)
    return {
        "form": form,
        "chosen": choices.parser,
        "entry": parsers()[choices.parser],
        "note": choices.note,
        "picker": picker_of(world, chosen, advice, choices.parser),
        "has_splits": choices.split is not None,
    }


def start(request: WorldRequest, world: World, form: RunForm) -> list[TrainingRun]:
    """Start the runs of the form, one per seed, and return them, new or already there. Where
    they are refused, return none and put the reason into the form."""
    try:
        answers = start_runs(world, request.user, **form.asked)
    except Refusal as error:
        form.add_error(None, error.message)
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


@never_cache
@world_view(Duty.MANAGE)
def split_runs(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """List what was trained on the split before: a part of the page of a split that follows one."""
    row = get_object_or_404(Split.objects.select_related("follows"), world=world, pk=pk)
    context = {"split": row, "rows": retrainable(row)}
    return render(request, "parser_service/runs/_split_runs.html", context)


@world_view(Duty.MANAGE, WRITE, does="retrain a run")
def run_retrain(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Start the configuration of a run on the newest split that follows its own."""
    run = get_object_or_404(
        TrainingRun.objects.select_related("split", "world"), world=world, pk=pk
    )
    try:
        answer = start_again(run, request.user)
    except Refusal as error:
        messages.warning(request, error.message)
        return redirect("run", world=world.name, pk=pk)
    if told := in_words([answer]):
        messages.info(request, told)
    return redirect("run", world=world.name, pk=answer[0].pk)


@may_take_long
@world_view(Duty.MANAGE, WRITE, does="train on the world of today")
def run_today(request: WorldRequest, world: World) -> HttpResponse:
    """Freeze the world of today, and train on it what answers here, or what is recommended."""
    try:
        started = start_today(world, request.user)
    except Refusal as error:
        messages.error(request, error.message)
        return redirect("run_new", world=world.name)
    if isinstance(started, Job):
        return redirect("job", pk=started.pk)
    if told := in_words([started]):
        messages.info(request, told)
    return redirect("run", world=world.name, pk=started[0].pk)


@dataclass(frozen=True, slots=True)
class RunChoices:
    """The parser, the split and the initial values of the form, with the advice on that split; ``note`` is a
    sentence about what could not be kept, or empty. ``split`` is None in a world without any."""

    parser: str
    split: Split | None
    advice: Advice
    initial: dict[str, Any] = field(default_factory=dict)
    note: str = ""


def choices_in(query: QueryDict, world: World) -> RunChoices:
    """Read the choices from an address: ``like`` names a run to repeat. The other parameters have the names
    of the fields; unknown ones are ignored."""
    initial: dict[str, Any]
    like = number_in(query.get("like", ""))
    run = world.runs.filter(pk=like).first() if like else None
    split = split_in(query, world)
    advice = advise(world, split)
    recommended = advice.recommendation
    parser = query.get("parser", run.parser if run else recommended.parser)
    if parser not in parsers():
        note = f"There is no parser called {parser!r} any more."
        initial = {"protocol": recommended.protocol}
        return RunChoices(recommended.parser, split, advice, initial, note)
    initial = values_of(run, parser) if run else {}
    if run is None:
        initial = {"split": split and split.pk, "train_sources": all_sources(split)}
        if parser == recommended.parser:
            initial["protocol"] = recommended.protocol
    names = [*GENERAL, *(PREFIX + each.name for each in config_fields(parser))]
    initial.update({name: query[name] for name in names if name in query})
    protocol, entry, note = initial.get("protocol"), parsers()[parser], ""
    if protocol not in (None, "", *entry.protocols):
        note = f"{entry.title} has no {protocol} protocol; {entry.protocols[0]} is chosen instead."
    return RunChoices(parser, split, advice, initial, note)


def split_in(query: QueryDict, world: World) -> Split | None:
    """Return the split that an address names, else the usual one."""
    key = number_in(query.get("split", ""))
    return world.splits.filter(pk=key or 0).first() or usual_split(world)


def all_sources(split: Split | None) -> str:
    """Return all that a split can be trained on."""
    return (written_sources(train_sources(split)) if split else "") or "gen"


def values_of(run: TrainingRun, parser: str) -> dict[str, Any]:
    """Return what the form for ``parser`` takes over from ``run``; hyperparameters from the same parser only."""
    general = {
        "split": run.split_id,
        "train_sources": run.train_sources,
        "protocol": run.protocol,
        "seed": run.seed,
        "share": float(f"{100 * run.train_share:g}"),
    }
    config = run.config if parser == run.parser else {}
    return {**general, **{PREFIX + name: value for name, value in config.items()}}


def query_of(posted: Mapping[str, str], parser: str, shown: str) -> str:
    """Return the address of the form for ``parser`` with the choices that were made while the form for
    ``shown`` was open."""
    kept = {name: posted[name] for name in GENERAL if name in posted}
    if parser == shown:
        defaults = {PREFIX + each.name: str(each.default) for each in config_fields(parser)}
        kept |= {
            name: posted[name]
            for name, default in defaults.items()
            if posted.get(name, default) != default
        }
    return urlencode({"parser": parser, **kept})


@dataclass(frozen=True, slots=True)
class ParserOption:
    """One parser. ``expected`` is what to expect of it on the split; ``seconds`` the median time of its finished
    runs here, None before the first; ``scores`` its best accuracies on the validation part, by source; ``gaps``
    the weights, or the server, that are not there. Where there are scores, they are shown instead of what to expect."""

    name: str
    entry: RegistryEntry
    expected: Expectation | None = None
    gaps: tuple[Gap, ...] = ()
    seconds: float | None = None
    scores: tuple[tuple[str, ShownScore], ...] = ()

    @property
    def sentence(self) -> str:
        return self.entry.in_short or self.entry.description


@dataclass(frozen=True, slots=True)
class ParserPicker:
    """All parsers, each once: the recommended one and why, others that can be trained now, and those that
    lack something. ``contents`` says what the split holds; None without a split."""

    recommended: ParserOption
    reason: str
    able: tuple[ParserOption, ...]
    lacking: tuple[ParserOption, ...]
    contents: SplitContents | None
    is_lacking_chosen: bool = False

    @property
    def options(self) -> tuple[ParserOption, ...]:
        return (self.recommended, *self.able, *self.lacking)


def picker_of(world: World, split: Split | None, advice: Advice, chosen: str = "") -> ParserPicker:
    """Return the parsers to choose from for ``split``, on which accuracies are. Two queries."""
    seconds, scores = _seconds(world), _scores(world, split)
    gaps, recommended = advice.gaps, advice.recommendation
    options = [
        ParserOption(
            name,
            entry,
            expectation_of(name, advice.material),
            tuple(gaps[name]),
            seconds.get(name),
            tuple(
                (words, scores[name][source])
                for source, words in SOURCE_WORDS.items()
                if source in scores[name]
            ),
        )
        for name, entry in parsers().items()
    ]
    others = [each for each in options if each.name != recommended.parser]
    return ParserPicker(
        recommended=next(each for each in options if each.name == recommended.parser),
        reason=recommended.reason,
        able=tuple(each for each in others if not each.gaps),
        lacking=tuple(each for each in others if each.gaps),
        contents=advice.contents,
        is_lacking_chosen=bool(gaps.get(chosen)) and chosen != recommended.parser,
    )


def _seconds(world: World) -> dict[str, float]:
    """Return the median seconds of training of the newest finished runs, by parser."""
    times: dict[str, list[float]] = defaultdict(list)
    runs = (
        world.runs.succeeded()
        .on_all_pairs()
        .order_by("-id")
        .values_list("parser", "seconds_trained")
    )
    for parser, seconds in runs[:MOST_RUNS]:
        times[parser].append(seconds)
    return {parser: median(each) for parser, each in times.items()}


def _scores(world: World, split: Split | None) -> dict[str, dict[str, ShownScore]]:
    """Return the best score by parser and source; by form that with the highest harmonic mean."""
    best: dict[str, dict[str, ShownScore]] = defaultdict(dict)
    if split is None:
        return best

    def rank(score: ShownScore) -> tuple[bool, float]:
        return not score.alone, score.accuracy

    rows = Evaluation.objects.filter(
        run__world=world,
        run__split=split,
        run__status=Status.SUCCEEDED,
        run__train_share=1,
        part__in=["validation", KNOWN],
        test_source__in=SOURCES,
    )
    of_runs: dict[tuple[str, int], list[Evaluation]] = defaultdict(list)
    for row in rows.select_related("run").defer("outcomes").order_by("test_source"):
        of_runs[row.run.parser, row.run_id].append(row)
    for (parser, _), of_run in of_runs.items():
        for (_, source), score in shown_scores(of_run, split.criterion).items():
            best[parser][source] = max(score, best[parser].get(source, score), key=rank)
    return best
