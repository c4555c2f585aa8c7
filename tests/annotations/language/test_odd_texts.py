"""Whatever the text, readers answer with values, problems or a LanguageError, and nothing else."""

from contextlib import suppress

from hypothesis import given
from hypothesis import strategies as st

from annotations.language.corpus import read_pairs, read_triples
from annotations.language.forms import (
    canonical_text,
    read_form,
    read_wildcard,
    to_reading,
    to_template,
)
from annotations.language.grammar import Grammar, read_productions
from annotations.language.grounding import Anonymizer
from annotations.language.templates import (
    generate,
    make_template,
    print_template,
    read_generator_files,
    set_problems,
    template_checker,
)
from annotations.language.templates.templates import read_templates
from annotations.language.texts.decoding import decode
from annotations.language.texts.errors import LanguageError
from annotations.language.world import gloss, infer_signatures, read_ontology
from annotations.language.world.gloss_patterns import read_pattern

PIECES = st.sampled_from(
    [
        *"(){}|,=$#;%\\/*\"<>&⟨⟩λ.: \n\t-²٣",
        "$Main", "$Main = ", "$a ", " = ", "{object", "{kobject 1}", "{void meta: ", "where ",
        "not ", "xor ", "1e999999", "1" * 5_000, "$" + "9" * 5_000, "x" * 300, "lambda ", "$1 e ",
        "UNKNOWN", "(go ", "go(", "λx. ", "# grammar name ", "; import ", "import \"../x\" as $b",
        "<names>", "<name a='b'>", "</name>", "</names>", "<!--", "-->", "<!DOCTYPE a [", "&#0;",
        "&#xD800;", "<?xml version='1.0'?>", "<![CDATA[", "name plural, name singular\n", "\x00",
        "\ud800", "\ufeff", "\u2028", "\x85", "\x1b", "{*}", "{0}", "{1=", "{99999999999:room}",
    ]
)  # fmt: skip
TEXTS = st.lists(PIECES | st.text(max_size=8), max_size=14).map("".join)
BYTES = st.one_of(TEXTS.map(lambda text: text.encode("utf-8", "surrogatepass")), st.binary())
FILES = st.dictionaries(
    st.sampled_from(
        ["gpsr_category_1_grammar.txt", "a.txt", "a_semantics.txt", "common.txt", "²_grammar.txt",
         "gpsr_category_1_semantics.txt", "١_grammar.txt", "_grammar.txt", ".txt"]
    ),
    BYTES,
)  # fmt: skip
ONTOLOGY = st.dictionaries(
    st.sampled_from(
        ["objects.xml", "locations.xml", "names.xml", "gestures.xml", "questions.xml",
         "categories.txt", "whattosay.txt"]
    ),
    BYTES,
)  # fmt: skip


@given(TEXTS)
def test_forms(text):
    with suppress(LanguageError):
        form = read_form(text)
        texts = canonical_text(form), to_template(form), to_reading(form)
        assert all(each.encode() for each in texts)
        assert gloss(form, infer_signatures([form])) is not None


@given(TEXTS)
def test_wildcards_and_gloss_patterns(text):
    read_pattern(text)
    with suppress(LanguageError):
        read_wildcard(text)


@given(TEXTS)
def test_grammars(text):
    grammar = Grammar(read_productions(text, "a.txt").productions)
    grammar.problems()
    with suppress(LanguageError):
        grammar.size()
        list(grammar.commands(limit=50))


@given(TEXTS, TEXTS)
def test_templates(pattern, form):
    read_templates(f"{pattern} = {form}", "t.txt")
    with suppress(LanguageError):
        template = make_template(pattern, form)
        print_template(template).encode()
        template_checker(Grammar(read_productions(pattern).productions)).problems(template)


@given(FILES)
def test_generator_folders(files):
    folder = read_generator_files(files)
    if not folder.has_errors:
        categories = folder.categories()
        with suppress(LanguageError):
            set_problems(categories, generate(categories, 500))


@given(ONTOLOGY, TEXTS)
def test_ontologies(files, text):
    ontology, _ = read_ontology(files)
    Anonymizer(ontology).anonymize(text)


@given(BYTES)
def test_pair_files(data):
    read_pairs(data, "p.txt")
    read_triples(data, "p.txt")
    with suppress(LanguageError):
        assert decode(data, "p.txt")
