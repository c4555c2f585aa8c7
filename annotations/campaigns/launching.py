"""Verb: launch a campaign: draw its prompts from the commands of a world."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from random import Random
from typing import Any

from django.db import IntegrityError
from django.db.models import Count

from annotations.background.progress import UNWATCHED, Progress
from annotations.generation.grounded_pairs import GroundedCommands, commands_to_ground
from annotations.language.corpus import Named, entities_of
from annotations.language.forms import canonical_text
from annotations.language.grounding import Grounded
from annotations.language.templates import Expansion
from annotations.language.texts import CHECK_WORDS, LanguageError, Refusal
from annotations.language.world import Ontology, gloss
from annotations.models import Campaign, CampaignPrompt, User, World
from annotations.models.campaigns import Balance, Wording
from annotations.rows.from_rows import ontology_of, predicates_of
from annotations.rows.synchronise import BATCH

MOST_PROMPTS = 20_000
_TRIES = 4  # for each prompt that shall differ from the others of its form


@dataclass(frozen=True, slots=True)
class PromptChoice:
    """Which commands become prompts.

    Attributes:
        task_categories: names; all without any.
        prompts_per_form: commands and groundings of one form, or of one line where these are balanced; as many as
            differ, at most.
        balance: what gets equally many prompts: each form or each line of the templates.
        target_per_form: forms with as many accepted paraphrases are left out.
        most_prompts: so many at most, None for all. More than ``MOST_PROMPTS`` are refused.
    """

    task_categories: tuple[str, ...] = ()
    prompts_per_form: int = 3
    target_per_form: int = 10
    wording: str = Wording.COMMAND
    balance: str = Balance.FORMS
    seed: int = 0
    most_prompts: int | None = None


@dataclass(frozen=True, slots=True)
class DrawnPrompt:
    """A prompt that is not stored yet; the columns of ``CampaignPrompt``."""

    expansion: Expansion
    grounded: Grounded
    grounded_form: str
    shown: str
    line: str
    entities: tuple[Named, ...]


def draw_prompts(world: World, choice: PromptChoice) -> list[DrawnPrompt]:
    """Draw prompts for each form that is below its target, or each line of such forms, in random order.

    Commands of one form or line take turns. The same world, choice and seed give the same prompts. A command for
    which the ontology has no value is left out.

    Raises:
        LanguageError: the world makes too many commands to draw from, or a stored text cannot be read.
        Refusal: nothing is left to ask for, or it would be more than ``MOST_PROMPTS``.
    """
    categories, expansions = commands_to_ground(world)
    if not expansions:
        said = "This world makes no commands yet. Write templates first: they give commands their forms."
        raise Refusal(said, "nothing_to_paraphrase")
    wanted = _below_target(world, expansions, choice)
    patterns = {
        category.name: [template.pattern_text for template in category.templates]
        for category in categories
    }
    groups: dict[str, list[Expansion]] = defaultdict(list)
    for expansion in wanted:
        line = patterns[expansion.task_category][expansion.template_index]
        groups[line if choice.balance == Balance.LINES else expansion.form_text].append(expansion)
    if choice.most_prompts is None and len(groups) * choice.prompts_per_form > MOST_PROMPTS:
        said = (
            f"{len(groups):,} {choice.balance} make too many prompts. Choose fewer task categories."
        )
        raise Refusal(said, "too_many_prompts")
    random, ontology, declared = Random(choice.seed), ontology_of(world), predicates_of(world)
    sources = {category.name: GroundedCommands(category) for category in categories}
    drawn: list[DrawnPrompt] = []
    for key in random.sample(list(groups), len(groups)):
        if len(drawn) >= (choice.most_prompts or MOST_PROMPTS):
            break
        for expansion, grounded in _draw(groups[key], sources, ontology, choice, random):
            shown = grounded.text
            if choice.wording == Wording.ENGLISH:
                shown = gloss(grounded.form, declared, ontology.classes, ontology.class_of_text)
            grounded_form = canonical_text(grounded.form)
            entities = entities_of(grounded, ontology)
            line = patterns[expansion.task_category][expansion.template_index]
            drawn.append(DrawnPrompt(expansion, grounded, grounded_form, shown, line, entities))
    if not drawn:
        said = (
            "No form is below its target here. Choose other task categories, or raise the target."
        )
        raise Refusal(said, "nothing_to_paraphrase")
    return drawn[: choice.most_prompts]


def launch(
    campaign: Campaign, choice: PromptChoice, by: User | None, progress: Progress = UNWATCHED
) -> Campaign:
    """Store an unsaved campaign with its prompts, and with its planted checks. It is open at once.

    Raises:
        LanguageError, Refusal: as ``draw_prompts``; the world has a campaign of that name.
    """
    progress.report(0, "drawing prompts")
    drawn = draw_prompts(campaign.world, choice)
    progress.report(0.8, "writing them")
    commands = dict(campaign.world.commands.values_list("anonymized_text", "pk"))
    campaign.wording, campaign.balance, campaign.seed = choice.wording, choice.balance, choice.seed
    campaign.target_per_form, campaign.created_by = choice.target_per_form, by
    prompts = [
        CampaignPrompt(
            command_id=commands.get(each.expansion.command),
            command_text=each.expansion.command,
            task_category=each.expansion.task_category,
            logical_form=each.expansion.form_text,
            prompt=each.grounded.text,
            grounded_form=each.grounded_form,
            line=each.line,
            shown=each.shown,
            entities=[row_of(named) for named in each.entities],
        )
        for each in drawn
    ]
    prompts += _checks(campaign)
    for position, prompt in enumerate(prompts, start=1):
        prompt.campaign, prompt.position = campaign, position
    try:
        with progress.writing():
            campaign.save()
            CampaignPrompt.objects.bulk_create(prompts, batch_size=BATCH)
            progress.conclude(report_of(campaign))
    except IntegrityError as error:
        raise name_taken(campaign.name) from error
    return campaign


def name_taken(name: str) -> Refusal:
    said = f"This world has a campaign called {name} already. Choose another name."
    return Refusal(said, "name_taken", HTTPStatus.CONFLICT)


def report_of(campaign: Campaign) -> dict[str, Any]:
    """Return what the job that launched a campaign reports."""
    counts = {"prompts": campaign.prompts.count()}
    return {"campaign": campaign.pk, "name": campaign.name, **counts}


def row_of(named: Named) -> dict[str, Any]:
    """Return an entity as ``CampaignPrompt.entities`` has it."""
    return {"text": named.text, "aliases": list(named.aliases), "is_described": named.is_described}


def _below_target(
    world: World, expansions: Sequence[Expansion], choice: PromptChoice
) -> Iterator[Expansion]:
    """Yield the commands of the chosen task categories whose forms have too few paraphrases."""
    accepted = world.paraphrases.accepted().values_list("logical_form").order_by()
    paraphrases = dict(accepted.annotate(Count("pk")))
    for expansion in expansions:
        is_chosen = not choice.task_categories or expansion.task_category in choice.task_categories
        if is_chosen and paraphrases.get(expansion.form_text, 0) < choice.target_per_form:
            yield expansion


def _draw(
    expansions: Sequence[Expansion],
    sources: dict[str, GroundedCommands],
    ontology: Ontology,
    choice: PromptChoice,
    random: Random,
) -> Iterator[tuple[Expansion, Grounded]]:
    """Yield prompts of one form or line whose texts differ: every command once, then again with other entities."""
    turns = random.sample(expansions, len(expansions))
    texts: set[str] = set()
    for turn in range(choice.prompts_per_form * _TRIES):
        expansion = turns[turn % len(turns)]
        try:
            grounded = sources[expansion.task_category].draw(expansion, ontology, random)
        except LanguageError:
            continue
        if grounded.text not in texts:
            texts.add(grounded.text)
            yield expansion, grounded
        if len(texts) == choice.prompts_per_form:
            return


def _checks(campaign: Campaign) -> Iterator[CampaignPrompt]:
    """Yield prompts that ask for words, which only somebody who reads writes."""
    for words in CHECK_WORDS if campaign.check_every else ():
        asked = f"This one is a check that you read along. Write only these words: {words}"
        yield CampaignPrompt(prompt=asked, shown=asked, check_words=words)
