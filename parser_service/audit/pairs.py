"""The labelled pairs of a world, as the audit reads them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from annotations.importing.prompts import CATEGORY_TOKEN
from annotations.labelling.spans import anonymizer_of
from annotations.language.auditing import LabelledPair
from annotations.language.english import ANY_OBJECT
from annotations.models import World
from annotations.rows.synchronise import BATCH
from parser_service.parsers.interface import Check, keep_going

_COLUMNS = ("pk", "utterance", "logical_form", "prompt", "command__anonymized_text")


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
    return [*_paraphrases(world, forms, check), *_utterances(world)]


def subject_of(pair: LabelledPair) -> tuple[str, int]:
    """Return what a pair of ``labelled_pairs`` is about, ``paraphrase`` or ``utterance``, and its key."""
    name, _, key = pair.key.rpartition("-")
    return name, int(key)


def _paraphrases(world: World, forms: Mapping[str, str], check: Check) -> Iterator[LabelledPair]:
    anonymizer = anonymizer_of(world)
    rows = world.paraphrases.accepted().values_list(*_COLUMNS)
    for key, utterance, form, prompt, command in rows.iterator(chunk_size=BATCH):
        check()
        source = command or anonymizer.anonymize(prompt).command
        text = anonymizer.anonymize(utterance).command
        yield LabelledPair(f"paraphrase-{key}", text, form, source, _behind(source, form, forms))


def _behind(source: str, label: str, forms: Mapping[str, str]) -> str:
    """Return the form of the command. A prompt that says "objects" may come from two commands, and the
    import cannot tell which: then it is that of either, the label's if it is one of them."""
    either = (source, source.replace(ANY_OBJECT, CATEGORY_TOKEN))
    known = [forms[text] for text in either if text in forms]
    return label if label in known else next(iter(known), "")


def _utterances(world: World) -> Iterator[LabelledPair]:
    rows = world.utterances.labelled().values_list("pk", "anonymized_text", "logical_form")
    for key, text, form in rows.iterator(chunk_size=BATCH):
        yield LabelledPair(f"utterance-{key}", text, form)
