from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import (
    FlagCode,
    FreeCommand,
    Named,
    Rewrite,
    check_flags,
    free_command_flags,
    read_triples,
    rewrite_flags,
)
from annotations.language.texts import KnownWords
from tests.annotations.language.published import SHARED, needs_corpus

MIXED = Path(__file__).with_name("mixed_submissions.txt")
PROMPT = "bring me the apple from the kitchen table"
APPLE = Rewrite("there's an apple on the kitchen table, fetch it", PROMPT)
ENGLISH = KnownWords([PROMPT])


def mixed() -> Iterator[tuple[Rewrite, frozenset[str]]]:
    """Yield each submission of the file with the flags that it should have."""
    own: dict[int, list[str]] = defaultdict(list)
    prompt, entities, others = "", (), []
    for line in MIXED.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            continue
        before, _, after = line.partition(" | ")
        if line.startswith(">"):
            names = [name.strip() for name in after.split(";")]
            entities = tuple(Named(name.lstrip("~"), (), name.startswith("~")) for name in names)
            prompt, others = before.removeprefix("> "), []
            continue
        contributor = own[len(others)]
        flags = frozenset(before.split()) - {"-"}
        yield Rewrite(after, prompt, entities, own=tuple(contributor), others=tuple(others)), flags
        contributor.append(after)
        others.append(after)


def codes(rewrite: Rewrite) -> set[str]:
    return {str(flag.code) for flag in rewrite_flags(rewrite, ENGLISH.__contains__)}


def test_flags_of_mixed_submissions_are_precise_and_complete() -> None:
    right: Counter[str] = Counter()
    given_: Counter[str] = Counter()
    wanted: Counter[str] = Counter()
    submissions = list(mixed())
    for rewrite, flags in submissions:
        said = codes(rewrite)
        right.update(said & flags)
        given_.update(said)
        wanted.update(flags)
    assert len(submissions) == 200
    assert set(wanted) == {"copy", "repeat", "lost_entity", "gibberish"}
    for code in wanted:
        assert right[code] >= 0.9 * given_[code], (code, right[code], given_[code])
        assert right[code] >= 0.8 * wanted[code], (code, right[code], wanted[code])


@needs_corpus
def test_few_published_paraphrases_are_called_gibberish() -> None:
    triples = read_triples((SHARED / "walker2019/paraphrasings.txt").read_bytes(), "").records
    known = KnownWords([each.command for each in triples])
    flagged = [
        each.paraphrase
        for each in triples
        if FlagCode.GIBBERISH
        in {
            flag.code
            for flag in rewrite_flags(Rewrite(each.paraphrase, each.command), known.__contains__)
        }
    ]
    assert len(flagged) <= len(triples) / 100, flagged


@pytest.mark.parametrize(
    ("changes", "code", "evidence"),
    [
        ({"text": f"Please {PROMPT}!"}, FlagCode.COPY, PROMPT),
        ({"own": (APPLE.text + ".",)}, FlagCode.REPEAT, APPLE.text + "."),
        ({"others": (APPLE.text.upper(),)}, FlagCode.REPEAT, APPLE.text.upper()),
        ({"seconds": 1.26}, FlagCode.TOO_FAST, "1.3 s"),
        (
            {"seconds": 2.1, "text": f"{APPLE.text}, as it is what I want"},
            FlagCode.TOO_FAST,
            "2.1 s",
        ),
        ({"entities": (Named("apple"), Named("pear"))}, FlagCode.LOST_ENTITY, "pear"),
        ({"text": "asdf jkjk table"}, FlagCode.GIBBERISH, "asdf jkjk"),
        ({"was_pasted": True}, FlagCode.PASTED, ""),
        ({"of_models": (APPLE.text,)}, FlagCode.LIKE_MODEL, APPLE.text),
    ],
)
def test_each_flag_has_its_evidence(changes: dict, code: FlagCode, evidence: str) -> None:
    flags = rewrite_flags(replace(APPLE, **changes), ENGLISH.__contains__)
    assert [(flag.code, flag.evidence) for flag in flags] == [(code, evidence)]


def test_what_took_its_time_and_is_like_no_other_has_no_flag() -> None:
    others = ("hand me the apple that lies on the kitchen table",)
    rewrite = replace(APPLE, seconds=12.0, own=("go to the bedroom",), others=others)
    assert rewrite_flags(rewrite, ENGLISH.__contains__) == ()


def test_a_planted_check_asks_for_words() -> None:
    assert check_flags("Purple, penguin.", "purple penguin") == ()
    (flag,) = check_flags("a purple thing", "purple penguin")
    assert (flag.code, flag.evidence) == (FlagCode.CHECK_FAILED, "penguin")


@pytest.mark.parametrize(
    ("text", "evidence"),
    [
        (PROMPT, PROMPT),
        ("good", "good"),
        ("asdf jkjk", "asdf jkjk"),
        ("water plants", "water the plants"),
    ],
)
def test_a_free_command_that_is_none_is_spam(text: str, evidence: str) -> None:
    command = FreeCommand(text, prompts=(PROMPT,), own=("water the plants",))
    (flag,) = free_command_flags(command, ENGLISH.__contains__)
    assert (flag.code, flag.evidence) == (FlagCode.SPAM, evidence)


def test_a_free_command_of_ones_own_has_no_flag() -> None:
    command = FreeCommand("fold my laundry", prompts=(PROMPT,), own=("water the plants",))
    assert free_command_flags(command, ENGLISH.__contains__) == ()


@given(st.text(max_size=60), st.text(max_size=60))
def test_any_text_can_be_flagged(text: str, prompt: str) -> None:
    flags = rewrite_flags(Rewrite(text, prompt, (Named(prompt),)), ENGLISH.__contains__)
    assert len({flag.code for flag in flags}) == len(flags)


def test_a_misspelt_word_is_mended_to_the_world_first() -> None:
    known = KnownWords(["the kitchen and the flurb"])
    assert known.mended("kitchn") == "kitchen"
    assert known.mended("flurp") == "flurb"
    assert known.mended("plese") == "please"
    assert known.mended("kitchen") is None
    assert known.mended("x" * 10_000) is None
