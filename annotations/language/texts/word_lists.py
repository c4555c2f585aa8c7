"""The word lists as values, read from TOML files beside this module or from a team's own in their place.

``data/*.toml`` holds the words and says what each list is for. A folder named by the environment variable
``GPSR_ENGLISH_DIR`` may hold files of the same names. Such a file replaces the whole of the one here.
"""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

VARIABLE = "GPSR_ENGLISH_DIR"
_KINDS: dict[type, str] = {str: "text", list: "list", dict: "table"}
_OURS = Path(__file__).resolve().parent / "data"


class EnglishError(ValueError):
    """A file of word lists cannot be used. Says which file, what is wrong, and what is expected."""


class WordFile:
    """One file of word lists, read when it is made.

    Raises EnglishError: the file is not TOML; a list is missing or has another shape.
    """

    def __init__(self, name: str) -> None:
        folder = Path(os.environ.get(VARIABLE) or _OURS)
        own = folder / f"{name}.toml"
        self._path = own if own.is_file() else _OURS / own.name
        try:
            self._values = tomllib.loads(self._path.read_text(encoding="utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise EnglishError(f"{self._path} is no TOML file: {error}.") from error

    def text(self, key: str) -> str:
        """Return a text."""
        return self._text(key, self._get(key))

    def expression(self, key: str) -> re.Pattern[str]:
        """Return a regular expression."""
        try:
            return re.compile(self.text(key))
        except re.error as error:
            raise EnglishError(
                f"{self._path}: “{key}” is no regular expression: {error}."
            ) from error

    def words(self, key: str) -> tuple[str, ...]:
        """Return a list of texts, in the order of the file."""
        return self._words(key, self._get(key))

    def groups(self, key: str) -> tuple[tuple[str, ...], ...]:
        """Return a list of lists of texts."""
        return tuple(self._words(key, each) for each in self._checked(key, self._get(key), list))

    def texts_by_name(self, key: str) -> dict[str, str]:
        """Return a table of texts."""
        return self._texts(key, self._get(key))

    def words_by_name(self, key: str) -> dict[str, tuple[str, ...]]:
        """Return a table of lists of texts."""
        return {name: self._words(key, each) for name, each in self._table(key).items()}

    def tables_by_name(self, key: str) -> dict[str, dict[str, str]]:
        """Return a table of tables of texts."""
        return {name: self._texts(key, each) for name, each in self._table(key).items()}

    def choices_by_name(self, key: str) -> dict[str, tuple[str | Mapping[str, str], ...]]:
        """Return a table of lists, each item a text or a table of texts."""
        return {
            name: tuple(
                each if isinstance(each, str) else self._texts(key, each)
                for each in self._checked(key, items, list)
            )
            for name, items in self._table(key).items()
        }

    def tables(self, key: str) -> Sequence[Mapping[str, Any]]:
        """Return a list of tables of texts and lists."""
        return [self._checked(key, each, dict) for each in self._checked(key, self._get(key), list)]

    def _get(self, key: str) -> Any:
        if key not in self._values:
            raise EnglishError(
                f"{self._path} has no “{key}”. A file that replaces a word list needs all that the "
                f"original has: see {_OURS / self._path.name}."
            )
        return self._values[key]

    def _table(self, key: str) -> dict[str, Any]:
        table: dict[str, Any] = self._checked(key, self._get(key), dict)
        return table

    def _texts(self, key: str, value: Any) -> dict[str, str]:
        table = self._checked(key, value, dict)
        return {name: self._text(key, each) for name, each in table.items()}

    def _text(self, key: str, value: Any) -> str:
        text: str = self._checked(key, value, str)
        return text

    def _words(self, key: str, value: Any) -> tuple[str, ...]:
        return tuple(self._text(key, each) for each in self._checked(key, value, list))

    def _checked(self, key: str, value: Any, kind: type) -> Any:
        if not isinstance(value, kind):
            raise EnglishError(
                f"{self._path}: under “{key}”, {value!r} stands where a {_KINDS[kind]} is expected. "
                f"{_OURS / self._path.name} shows how."
            )
        return value


_words = WordFile("words")
ARTICLES = frozenset(_words.words("articles"))
DETERMINERS = frozenset(_words.words("determiners"))
NEGATIONS = frozenset(_words.words("negations"))
BOUNDARIES = frozenset(_words.words("boundaries"))
PLACE_PREPOSITIONS = frozenset(_words.words("place_prepositions"))
CHOOSING_WORDS = frozenset(_words.words("choosing"))
CHOICE_FILLERS = frozenset(_words.words("choice_fillers"))
VAGUE_WORDS = frozenset(_words.words("vague"))
LIGHT_WORDS = frozenset(_words.words("light"))
GOING_WORDS = frozenset(_words.words("going"))
ASKING_WORDS = frozenset(_words.words("asking"))
POLITE_OPENINGS = _words.words("polite_openings")
NO_COMMAND_WORDS = frozenset(_words.words("no_command"))

_titles = WordFile("titles")
TITLE_SPELLINGS = _titles.groups("spellings")
# What stands before the name of a person, in small letters.
TITLES = frozenset(
    each.casefold() for each in (*_titles.words("callings"), *chain(*TITLE_SPELLINGS))
)

_courtesy = WordFile("courtesy")
COURTESY_OPENINGS = _courtesy.words("openings")
COURTESY_CLOSINGS = _courtesy.words("closings")
COURTESY_ANYWHERE = _courtesy.words("anywhere")

_nouns = WordFile("nouns")
NUMBERS = _nouns.words("numbers")
PERSON_WORDS = frozenset(_nouns.words("persons"))
THING_WORDS = frozenset(_nouns.words("things"))
RECIPIENT_PRONOUNS = _nouns.words("recipients")
ANY_OBJECT = _nouns.text("any_object")
OPEN_CATEGORIES = _nouns.words("open_categories")
REFERENCES = _nouns.words_by_name("references")
KINDS_OF_PLACES = tuple(map(frozenset, _nouns.groups("kinds_of_places")))
OBFUSCATED = _nouns.texts_by_name("obfuscated")
PRONOUNS = _nouns.tables_by_name("pronouns")

_inflection = WordFile("inflection")
PLURALS = _inflection.words_by_name("plurals")
UNCHANGING = frozenset(_inflection.words("unchanging"))
SINGULARS_IN_S = frozenset(_inflection.words("singulars_in_s"))
NOUNS_IN_I_OR_U = frozenset(_inflection.words("nouns_in_i_or_u"))
NO_ENDINGS = frozenset(_inflection.words("no_endings"))
NOUNS_IN_IE = frozenset(_inflection.words("nouns_in_ie"))
_articles = _inflection.words_by_name("articles")
BEGINNINGS_AFTER_A, BEGINNINGS_AFTER_AN = _articles["a"], _articles["an"]
LETTERS_AFTER_AN = _articles["letters"]

_answers = WordFile("answers")
YES_WORDS = frozenset(_answers.words("yes"))
NO_WORDS = frozenset(_answers.words("no"))
STOP_WORDS = frozenset(_answers.words("stop"))
ANSWER_OPENINGS = frozenset(_answers.words("openings"))
IS_NEW = _answers.expression("new")
IS_EITHER = _answers.expression("either")

_glosses = WordFile("glosses")
RELATIONS = frozenset(_glosses.words("relations"))
PREPOSITIONS = _glosses.texts_by_name("prepositions")
KNOWN_PATTERNS = _glosses.texts_by_name("predicates")

_contrasts = WordFile("contrasts")
PREDICATE_WORDS = _contrasts.words_by_name("words")
CONTRASTS = _contrasts.groups("contrasts")
NEAR_SYNONYMS = _contrasts.groups("near_synonyms")

_arguments = WordFile("arguments")
ARGUMENT_NAMES = _arguments.choices_by_name("names")
NEEDED_ARGUMENTS = _arguments.words_by_name("needed")

_questions = WordFile("questions")
QUESTION_WORDS = {
    entity_class: word
    for word, classes in _questions.words_by_name("words").items()
    for entity_class in classes
}
QUESTION_NOUNS = _questions.texts_by_name("nouns")
ARGUMENT_QUESTION_WORDS = _questions.texts_by_name("arguments")
PREPOSITIONS_OF_WHERE = frozenset(_questions.words("prepositions_of_where"))
PREPOSITIONS_LEFT_OUT = frozenset(_questions.words("prepositions_left_out"))
ACTION_QUESTION_PATTERNS = _questions.texts_by_name("actions")
AMONG_WHAT = _questions.text("superlative")
WHOLE_QUESTIONS = _questions.tables_by_name("whole")
DESCRIPTION_QUESTIONS = _questions.tables_by_name("descriptions")

_paraphrases = WordFile("paraphrases")
COURTESY_WORDS = frozenset(_paraphrases.words("courtesy"))
CHECK_WORDS = _paraphrases.words("checks")

_rewordings = WordFile("rewordings")
REWORDING_OPENINGS = _rewordings.words("openings")
REWORDING_CLOSINGS = _rewordings.words("closings")
REWORDED_JOINTS = _rewordings.words("joints")
REWORDING_DETERMINERS = _rewordings.words("determiners")
REWORDING_PERSONS = _rewordings.words("persons")
REWORDING_THINGS = _rewordings.words("things")
REWORDED_PATTERNS = _rewordings.words_by_name("patterns")

_joints = WordFile("joints")
JOINTS = _joints.words("joints")
JOINT_OPENINGS = _joints.words("openings")
COMMAND_NOUNS = frozenset(_joints.words("nouns"))
SEQUENCE_WORDS = frozenset(_joints.words("sequence"))
SEQUENCE_NOUNS = frozenset(_joints.words("sequence_nouns"))
FINISHED_WORDS = _joints.words("finished")
TELLING_WORDS = frozenset(_joints.words("telling"))

_other_requests = WordFile("other_requests")
FORBIDDING_PHRASES = _other_requests.words("forbidding")
CONDITIONAL_PHRASES = _other_requests.words("conditions")
TAKING_BACK_PHRASES = _other_requests.words("taking_back")
POLITE_BEFORE_IF = _other_requests.words("polite_before_if")
POLITE_AFTER_IF = _other_requests.words("polite_after_if")
EXCUSING_PHRASES = _other_requests.words("excusing")
EXCUSED_PHRASES = _other_requests.words("excused")
ORDERING_PHRASES = _other_requests.words("ordering")
SUBJECT_WORDS = _other_requests.words("subjects")
SEVERAL_PHRASES = _other_requests.words("several")
COUNTING_PHRASES = _other_requests.words("counting")
WANTING_PHRASES = _other_requests.words("wanting")
PAST_VERBS = _other_requests.words("past")
ADVERBS = _other_requests.words("adverbs")
TIME_PHRASES = _other_requests.words("times")
REPORTING_VERBS = _other_requests.words("reporting")
THINKING_PHRASES = _other_requests.words("thinking")
IMAGINING_PHRASES = _other_requests.words("imagining")
INDEFINITE_PERSONS = _other_requests.words("indefinite_persons")

# Words that nobody has to look up: those of the lists, which say little by themselves.
ENGLISH_WORDS = frozenset(
    word
    for phrases in (
        *(
            BOUNDARIES,
            DETERMINERS,
            NEGATIONS,
            PLACE_PREPOSITIONS,
            CHOOSING_WORDS,
            CHOICE_FILLERS,
            VAGUE_WORDS,
        ),
        *(
            PERSON_WORDS,
            THING_WORDS,
            NO_COMMAND_WORDS,
            COURTESY_WORDS,
            COURTESY_OPENINGS,
            COURTESY_CLOSINGS,
        ),
        *(
            JOINTS,
            JOINT_OPENINGS,
            NUMBERS,
            FORBIDDING_PHRASES,
            CONDITIONAL_PHRASES,
            TAKING_BACK_PHRASES,
        ),
        *(
            POLITE_BEFORE_IF,
            POLITE_AFTER_IF,
            EXCUSING_PHRASES,
            EXCUSED_PHRASES,
            SEVERAL_PHRASES,
            YES_WORDS,
            NO_WORDS,
        ),
    )
    for phrase in phrases
    for word in re.findall(r"[\w']+", phrase.casefold())
)


_hearing = WordFile("hearing")
SOUNDS = _hearing.words("sounds")
FILLERS = _hearing.words("fillers")
REPAIRS = _hearing.words("repairs")
HEARD_OPENINGS = _hearing.words("openings")
HEARD_CLOSINGS = _hearing.words("closings")
HEARD_ANYWHERE = _hearing.words("anywhere")
CALLS = _hearing.words("calls")
CONTRACTIONS = _hearing.texts_by_name("contractions")
LIKE_CONTRACTIONS = _hearing.texts_by_name("like_contractions")
OPEN_WORDS = frozenset(_hearing.words("open_words"))
KEPT_WORDS = frozenset(_hearing.words("kept"))
POSSESSIVES = frozenset(_hearing.words("possessives"))
ALIKE = _hearing.groups("alike")
AGREEING = _hearing.groups("agreeing")
SYNONYMS = _hearing.groups("synonyms")


@cache
def sample_commands() -> tuple[tuple[str, str], ...]:
    """Return commands with their forms, both with numbered class tokens."""
    groups = WordFile("sample_commands").tables("commands")
    return tuple((text, group["form"]) for group in groups for text in group["texts"])


@cache
def unrelated_sentences() -> tuple[str, ...]:
    """Return sentences that are no command."""
    return WordFile("unrelated_sentences").words("sentences")


class RequestGroup(NamedTuple):
    """Examples of one kind of request that is no command, unless a world has one of ``actions``."""

    gloss: str
    texts: tuple[str, ...]
    actions: tuple[str, ...]


@cache
def other_request_groups() -> tuple[RequestGroup, ...]:
    """Return what people say to a robot that is none of its commands, by kind."""
    groups = _other_requests.tables("requests")
    return tuple(
        RequestGroup(each["gloss"], tuple(each["texts"]), tuple(each.get("actions", ())))
        for each in groups
    )
