"""What people leave in a world that they work in together, so that every page has something to show."""

from __future__ import annotations

from annotations.background.progress import UNWATCHED
from annotations.editing.commenting import SUBJECTS, add_comment
from annotations.editing.edits import add, change, delete
from annotations.labelling.audit_findings import store_findings
from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import refill, set_share
from annotations.labelling.item_answers import answer
from annotations.language.corpus import Part
from annotations.language.plans import Offer
from annotations.models import (
    AuditEntry,
    Entity,
    Invitation,
    Job,
    JobKind,
    Paraphrase,
    SemanticTemplate,
    User,
    Utterance,
    Verdict,
    WorkKind,
    World,
)
from annotations.models.background import Status
from annotations.models.worlds import Role
from parser_service.models import Promotion, PromotionState, Slice, TrainingRun
from parser_service.reviews.analysis_job import analyse
from parser_service.reviews.category_proposals import propose_for_run
from parser_service.reviews.tagging import tag, write_note
from parser_service.reviews.tryout_answers import ask
from parser_service.reviews.world_categories import ensure_categories
from parser_service.runs.checkpoints import model_folder, write_folder
from parser_service.runs.promoting import promote
from parser_service.runs.split_pairs import pairs_of
from parser_service.runs.train_run import make_parser
from parser_service.serving.conversation import reply, start
from parser_service.serving.entity_offers import offer, refuse
from tests.doubted_labels import doubt

SAID = ["bring me the tea", "go to the kitchen now", "where is my milk"]


def leave_traces(world: World, annotator: User, admin: User) -> None:
    """Let ``annotator`` and ``admin`` edit, delete, comment and label in ``world``, and differ once.

    Afterwards some templates are disputed, in conflict or match nothing, an utterance has two labels, and
    a label is in doubt.
    """
    _edit(world, annotator, admin)
    _invite(world, admin)
    _comment(world, annotator, admin)
    _label(world, annotator, admin)
    _doubt(world)
    _analyse(world, annotator)
    _promote(world, admin)
    _review(world, annotator, admin)
    _talk(world, annotator)
    _fail(world, annotator)


def save_parser(run: TrainingRun) -> None:
    """Store the parser of a run that was only written down as succeeded."""
    parser = make_parser(run)
    parser.fit(pairs_of(run.split, Part.TRAIN, run.train_sources))
    write_folder(model_folder(run.pk), parser.save)


def _invite(world: World, admin: User) -> None:
    """Let somebody invite a class, and the audit log say so."""
    AuditEntry.objects.create(
        world=world, world_name=world.name, who=admin, who_name=admin.username, what="invite"
    )
    Invitation.issue(world, [Role.ANNOTATOR], admin, days=7, places=20, note="A class")


def _comment(world: World, annotator: User, admin: User) -> None:
    """Let people talk about a template."""
    template = SemanticTemplate.objects.filter(grammar__world=world).first()
    text = f"Is this what people say? @{admin.get_username()} please look."
    add_comment(world, SUBJECTS["template"], template, text, annotator)
    add_comment(world, SUBJECTS["template"], template, "Yes, they do.", admin)


def _label(world: World, annotator: User, admin: User) -> None:
    """Let people label an utterance differently, and dispute another."""
    collect(world, SAID, by=annotator)
    set_share(world, WorkKind.UNLABELLED, 100)
    refill(world)
    spoken, disputed = Utterance.objects.filter(world=world)[:2]
    answer(spoken, Verdict.FORM, '( go " <room> " )', annotator, spoken.version, 4.2)
    answer(spoken, Verdict.UNKNOWN, "", admin, spoken.version, 6.0)
    reason = "Whose milk is meant?"
    answer(disputed, Verdict.DISPUTE, "", admin, disputed.version, 8.0, reason)
    refill(world)


def _doubt(world: World) -> None:
    """Let an audit doubt the label of a paraphrase."""
    texts = dict.fromkeys(("prompt", "utterance"), "Fetch me the tea.")
    forms = dict.fromkeys(("grounded_form", "logical_form"), "UNKNOWN")
    distances = {"edit_distance": 3, "jaccard_distance": 0.5}
    paraphrase, _ = Paraphrase.objects.get_or_create(
        world=world, position=0, defaults={**texts, **forms, **distances}
    )
    store_findings(world, [doubt(paraphrase, '( go " <room> " )')])


def _fail(world: World, annotator: User) -> None:
    """Let a job fail."""
    Job.objects.create(
        world=world,
        world_name=world.name,
        kind=JobKind.GENERATE,
        created_by=annotator,
        status=Status.FAILED,
        failure="The worker was stopped.",
    )


def _analyse(world: World, annotator: User) -> None:
    """Let the errors of a run be analysed by its parser, and somebody try a text on it."""
    run = TrainingRun.objects.succeeded().filter(world=world).first()
    save_parser(run)
    analyse(Job(world=world, kind=JobKind.ANALYSE, arguments={"run": run.pk}), UNWATCHED)
    ask(world, annotator, "Bring an umbrella", [run])


def _promote(world: World, admin: User) -> None:
    """Let a run answer, after another one, and propose the latter again."""
    runs = list(TrainingRun.objects.succeeded().filter(world=world))
    promote(runs[-1], None, "The first run of this world.")
    if len(runs) > 1:
        promote(runs[0], admin, "It is right more often.")
        Promotion.objects.create(
            world=world,
            run=runs[-1],
            state=PromotionState.PROPOSED,
            reason="Trained after the corpus changed.",
        )


def _talk(world: World, annotator: User) -> None:
    """Let somebody ask for what nobody knows, and agree; let another word wait and one be refused."""
    form = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) )'
    parsed = {"candidates": [{"form": form}], "is_unknown": False}
    for answers in (["new", "yes"], []):
        row = start(world, "bring me the flurb", annotator, lambda *_: parsed)
        for each in answers:
            row = reply(row, each)
    refuse(offer(world, Offer("object", "glim"), "where is the glim"), annotator)
    offer(world, Offer("object", "tea", "brew"), "bring me the brew")


def _review(world: World, *reviewers: User) -> None:
    """Let people differ about why the answers of the world's runs are wrong."""
    saved, _ = Slice.objects.get_or_create(world=world, name="short", query="max_words=5")
    Slice.objects.create(world=world, name="a slice with a name " * 4, query="source=generated")
    categories = ensure_categories(world)
    categories["overly_sensitive"].slice = saved
    categories["overly_sensitive"].save()
    for run in TrainingRun.objects.filter(world=world):
        propose_for_run(run, frozenset(), UNWATCHED)
        wrong = run.predictions.best().filter(is_exact_match=False).select_related("example")
        for number, row in enumerate(wrong):
            for place, person in enumerate(reviewers):
                code = "wrong_structure" if number % 3 == place else "wrong_predicate"
                tag(run, row.example, categories[code], person)
            write_note(run, row.example, "Nobody says this to a robot.", reviewers[0])


def _edit(world: World, annotator: User, admin: User) -> None:
    category = world.grammar.task_categories.first()
    first = SemanticTemplate.objects.filter(grammar__world=world).first()
    change(first, {"status": "disputed"}, annotator, first.version)
    for pattern, form in ((first.pattern, "UNKNOWN"), ("nobody says this", "UNKNOWN")):
        add(SemanticTemplate.for_category(category, pattern=pattern, form=form), annotator)
    entity = Entity.objects.filter(ontology__world=world).first()
    change(entity, {"aliases": ["cuppa"]}, admin, entity.version)
    last = Entity.objects.filter(ontology__world=world).last()
    delete(last, admin, last.version)
