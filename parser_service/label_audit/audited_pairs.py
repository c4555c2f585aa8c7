"""The labelled pairs of a world, as the audit reads them."""

from __future__ import annotations

from collections.abc import Mapping

from annotations.importing.prompt_sources import CATEGORY_TOKEN
from annotations.labelling.entity_spans import anonymizer_of
from annotations.language.english import ANY_OBJECT
from annotations.language.label_errors import LabelledPair
from annotations.models import World
from annotations.rows.synchronise import BATCH
from parser_service.parsers.interface import Check, keep_going


def command_forms(world: World) -> dict[str, str]:
    """Return the form of each generated command by its text."""
    return dict(world.commands.values_list("anonymized_text", "logical_form__text"))


def labelled_pairs(
    world: World, forms: Mapping[str, str], check: Check = keep_going
) -> list[LabelledPair]:
    """Return the accepted paraphrases and the labelled utterances of ``world`` with class tokens.

    Keys are ``paraphrase-N`` and ``utterance-N`` with the primary key of the row. The command behind a
    paraphrase is the generated one, or else its prompt.

    Args:
        forms: what ``command_forms`` returns.
    """
    pairs = []
    anonymizer = anonymizer_of(world)
    columns = ("pk", "utterance", "logical_form", "prompt", "command__anonymized_text")
    paraphrases = world.paraphrases.accepted().values_list(*columns)
    for key, utterance, label, prompt, command in paraphrases.iterator(chunk_size=BATCH):
        check()
        source = command or anonymizer.anonymize(prompt).command
        # A prompt that says "objects" may come from two commands, and the import cannot tell which: then the form
        # behind it is that of either, the label's if it is one of them.
        either = (source, source.replace(ANY_OBJECT, CATEGORY_TOKEN))
        known = [forms[text] for text in either if text in forms]
        behind = label if label in known else next(iter(known), "")
        text = anonymizer.anonymize(utterance).command
        pairs.append(LabelledPair(f"paraphrase-{key}", text, label, source, behind))
    utterances = world.utterances.labelled()
    rows = utterances.values_list("pk", "anonymized_text", "logical_form")
    for key, text, label in rows.iterator(chunk_size=BATCH):
        pairs.append(LabelledPair(f"utterance-{key}", text, label))
    return pairs


def subject_of(pair: LabelledPair) -> tuple[str, int]:
    """Return what a pair of ``labelled_pairs`` is about, ``paraphrase`` or ``utterance``, and its key."""
    name, _, key = pair.key.rpartition("-")
    return name, int(key)
