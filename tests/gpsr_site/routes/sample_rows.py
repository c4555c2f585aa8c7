"""The row of a sample world that a route is about, made where there is none."""

from __future__ import annotations

from datetime import timedelta

from django.db.models import Model
from django.utils import timezone

from annotations.language.plans import DialogueState, Offer, Phase
from annotations.models import (
    AuditDecision,
    AuditFinding,
    Campaign,
    EntityClass,
    Invitation,
    Job,
    Label,
    Membership,
    Submission,
    Upload,
    User,
    Utterance,
    WorkItem,
)
from annotations.models.people import digest_of
from annotations.models.worlds import Role
from annotations.rows.composition import new_category
from parser_service.models import Dialogue, OfferedEntity, Promotion, PromotionState, Slice
from parser_service.reviews.world_categories import ensure_categories
from parser_service.serving.entity_offers import offer
from tests.sample_world import SampleWorld, own_class_in, paraphrase_in


def waiting_job(sample: SampleWorld) -> Job:
    world = sample.world
    return Job.objects.get_or_create(world=world, world_name=world.name, kind="import_generator")[0]


def job_without_world(sample: SampleWorld) -> Job:
    """Return the import of a world that is not there yet, which nobody of the policy asked for."""
    name = f"copy-of-{sample.world}"
    return Job.objects.get_or_create(world=None, world_name=name, kind="import_world")[0]


def proposal(sample: SampleWorld) -> Promotion:
    """Return a proposal that nobody has decided."""
    return Promotion.objects.get_or_create(
        world=sample.world, run=sample.run, state=PromotionState.PROPOSED
    )[0]


def removable_member(sample: SampleWorld) -> User:
    """Return somebody with a role in the world, whom no test needs."""
    user, _ = User.objects.get_or_create(username=f"someone in {sample.world}")
    Membership.objects.get_or_create(world=sample.world, user=user, role=Role.REVIEWER)
    return user


def invitation(sample: SampleWorld) -> Invitation:
    """Return an invitation to the world, whose link has a key that ``key_of`` knows."""
    later = timezone.now() + timedelta(days=1)
    values = {"roles": [Role.REVIEWER], "places": 100, "expires_at": later}
    values["created_by"], _ = User.objects.get_or_create(username=f"host of {sample.world}")
    Membership.objects.get_or_create(world=sample.world, user=values["created_by"], role=Role.ADMIN)
    return Invitation.objects.get_or_create(
        world=sample.world, digest=digest_of(key_of(sample)), defaults=values
    )[0]


def key_of(sample: SampleWorld) -> str:
    return f"key-of-{sample.world}"


def join_keys(sample: SampleWorld) -> dict[str, object]:
    invitation(sample)
    return {"key": key_of(sample)}


def campaign_row(sample: SampleWorld) -> Campaign:
    """Return a campaign with a prompt, a contributor, and what they submitted; what is missing is made."""
    sizes = {"task_size": 1, "free_commands": 0}
    row, _ = Campaign.objects.get_or_create(world=sample.world, name="first", defaults=sizes)
    if not row.key:
        row.key = f"campaign-of-{sample.world}"
        row.save()
    texts = {"prompt": "go there", "shown": "go there"}
    forms = {"logical_form": "go", "grounded_form": "go"}
    prompt, _ = row.prompts.get_or_create(position=1, defaults={**texts, **forms})
    contributor, _ = row.contributors.get_or_create(pseudonym="f00d")
    values = {"prompt": prompt, "text": "move over there", "answered_at": timezone.now()}
    contributor.submissions.get_or_create(position=1, defaults=values)
    return row


def submission(sample: SampleWorld) -> Submission:
    """Return what a contributor of the campaign wrote, which nobody has decided about."""
    row = Submission.objects.answered().filter(contributor__campaign=campaign_row(sample)).first()
    assert row is not None
    return row


def contributor_row(sample: SampleWorld) -> Model:
    return campaign_row(sample).contributors.first()


def campaign_key(sample: SampleWorld) -> dict[str, object]:
    return {"key": campaign_row(sample).key}


def utterance(sample: SampleWorld) -> Utterance:
    texts = {"text": "bring me tea", "anonymized_text": "bring me <object>"}
    return Utterance.objects.get_or_create(world=sample.world, **texts)[0]


def upload(sample: SampleWorld) -> Upload:
    """Return an upload that is stored and not undone, of an account that was deleted."""
    values = {"added": 0, "stored_at": timezone.now()}
    return Upload.objects.get_or_create(world=sample.world, file_name="said.csv", defaults=values)[
        0
    ]


def answer_of_nobody(sample: SampleWorld) -> Label:
    """Return an answer to the utterance, of an account that was deleted."""
    return Label.objects.get_or_create(utterance=utterance(sample), verdict="skip")[0]


def work_item(sample: SampleWorld) -> WorkItem:
    """Return what the queue asks about the utterance."""
    row = utterance(sample)
    return WorkItem.objects.get_or_create(
        world=sample.world, utterance=row, title=row.text, kind="unlabelled", priority=10
    )[0]


def finding(sample: SampleWorld) -> AuditFinding:
    """Return a label that is in doubt."""
    forms = {"form": "( go )", "suggested_form": "( find )"}
    return AuditFinding.objects.get_or_create(
        world=sample.world,
        paraphrase=paraphrase_in(sample.world),
        defaults={**forms, "rank": 1, "score": 1.0},
    )[0]


def decision_of_nobody(sample: SampleWorld) -> AuditDecision:
    """Return what somebody whose account was deleted decided about it."""
    return AuditDecision.objects.get_or_create(finding=finding(sample), decision="kept")[0]


def saved_slice(sample: SampleWorld) -> Slice:
    return Slice.objects.get_or_create(
        world=sample.world, name="wrong ones", query="outcome=wrong"
    )[0]


def error_category(sample: SampleWorld) -> Model:
    return list(ensure_categories(sample.world).values())[-1]


def review(sample: SampleWorld) -> Model:
    """Return what somebody whose account was deleted wrote about an answer."""
    return sample.run.reviews.get_or_create(example=sample.example, note="Hm.")[0]


def dialogue(sample: SampleWorld) -> Dialogue:
    """Return a dialogue about a command that nobody understood."""
    state = DialogueState(Phase.REPHRASING, prompt="Please say it another way.").as_json()
    values = {"state": state, "phase": "rephrasing"}
    return Dialogue.objects.get_or_create(world=sample.world, utterance="dance", defaults=values)[0]


def offered_entity(sample: SampleWorld) -> OfferedEntity:
    return offer(sample.world, Offer("object", "flurb"), "bring me the flurb")


def entity_class(sample: SampleWorld) -> EntityClass:
    """Return a class that not every world has."""
    return own_class_in(sample.world)


def recipe(sample: SampleWorld) -> Model:
    return sample.world.recipes.first()


def primitive(sample: SampleWorld) -> Model:
    """Return a primitive that no recipe uses, so that it can be deleted."""
    values = {"text": "dance()", "position": 1_000}
    return sample.world.primitives.get_or_create(name="dance", defaults=values)[0]


def task_category(sample: SampleWorld) -> Model:
    """Return a task category without productions and templates, so that it can be deleted."""
    category = new_category(sample.world.grammar, "watering")
    values = {
        **{name: getattr(category, name) for name in ("rule_sources", "template_sources")},
        "position": 1_000,
    }
    return sample.world.grammar.task_categories.get_or_create(name=category.name, defaults=values)[
        0
    ]


def predicate(sample: SampleWorld) -> Model:
    return sample.world.predicates.first()


def template(sample: SampleWorld) -> Model:
    return sample.template


def split(sample: SampleWorld) -> Model:
    return sample.split


def run(sample: SampleWorld) -> Model:
    return sample.run
