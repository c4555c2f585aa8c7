"""Lines for nonterminals: their forms compose along the derivation, in generation and in parsing alike."""

from random import Random

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from annotations.language.corpus.names import rename_nonterminal_in_pattern
from annotations.language.forms import (
    canonical_text,
    loose_references,
    places_in_pattern,
    print_sequence,
    read_form,
    to_corpus,
    to_template,
)
from annotations.language.grammar import Budget, Grammar, Recognizer, read_productions
from annotations.language.grounding import (
    FormSlots,
    UtteranceReader,
    fill_all,
    ground,
    with_values,
)
from annotations.language.templates import (
    Balance,
    Language,
    SampleRequest,
    TaskCategory,
    TemplateChart,
    TemplateExpander,
    generate,
    generation_size,
    print_template,
    read_sides,
    read_template,
    set_problems,
    shared_problems,
    template_checker,
)
from annotations.language.templates.line_checks import line_problems
from annotations.language.templates.sides import format_form, format_pattern
from annotations.language.texts.errors import LanguageError
from annotations.language.world import Entity, Ontology, infer_signatures
from tests.annotations.language.random_grammars import FEW, TOKENS, small_grammars
from tests.annotations.language.templates.test_expansion import small_templates

RULES = """
$Main = $goto | $goto $next
$goto = ( go | walk ) to the {room}
$next = and find the {kobject} | then $do | and say hello
$do = $place it on the {placement} | bring it to me
$place = put | place
"""
GRAMMAR = Grammar(read_productions(RULES).productions)
GOTO = "$goto -> (go | walk) to the {room 1} = (go {room 1})"
FIND = "$next -> and find the {kobject} = (find {kobject})"
THEN = "$next -> then $do = $do"
PLACE = "$do -> $place it on the {placement 1} = (sequence (take it) (put it {placement 1}))"
BRING = "$do -> bring it to me = (bring it)"
BOTH = "$goto $next = (sequence $goto $next)"


def category(*lines, grammar=GRAMMAR):
    return TaskCategory("1", grammar, tuple(map(read_template, lines)))


ALL = category("$goto = $goto", BOTH, GOTO, FIND, THEN, PLACE, BRING)


def forms(*categories):
    return {each.command: each.form_text for each in generate(categories).expansions}


OPTIONAL = """
$Main = find $what $where | follow $what $whereto
$what = the {kobject} | it
$where = in the {room} | {void}
$whereto = to the {room} | {void}
"""
NOTHING = category(
    "find $what $where = (find (λ$1:e (is_a $1 $what) (at $1 $where)))",
    "follow $what $whereto = (follow $what $whereto)",
    "$where -> in the {room 1} = (room {room 1})",
    "$where -> {void} = UNKNOWN",
    "$whereto -> $place = $place",
    "$place -> to the {room 1} = (room {room 1})",
    "$place -> {void} = UNKNOWN",
    grammar=Grammar(
        read_productions(f"{OPTIONAL}$place = to the {{room}} | {{void}}\n").productions
    ),
)


def test_a_line_that_says_nothing_takes_its_argument_or_its_description_away():
    """Alike in generation, in the chart and in a sample; also through a line that takes up such a line."""
    wanted = {
        "find the <object> in the <room>": '(find (λ$1:e (is_a $1 "the <object>") (at $1 (room "<room>"))))',
        "find the <object>": '(find (λ$1:e (is_a $1 "the <object>")))',
        "find it": '(find (λ$1:e (is_a $1 "it")))',
        "follow it to the <room>": '(follow "it" (room "<room>"))',
        "follow it": '(follow "it")',
    }
    found = forms(NOTHING)
    chart = TemplateChart([NOTHING])
    drawn = Language([NOTHING]).sample(SampleRequest(100, balance=Balance.FORMS)).generated
    sampled = {each.command: each.form_text for each in drawn.expansions}
    for command, form in wanted.items():
        text = canonical_text(read_form(form))
        assert found[command] == sampled[command] == text
        assert {each.form_text for each in chart.parse(command)} == {text}
    assert set(found) == set(sampled) and len(found) == 8
    entities = Ontology((Entity("object", "cola"), Entity("room", "hall")))
    expander = TemplateExpander(NOTHING.grammar, NOTHING.lines)
    made = {
        grounded.text: canonical_text(grounded.form)
        for template in NOTHING.templates[:2]
        for each in expander.derivations(template)
        for grounded in (ground(each.symbols, each.form, entities, Random(1)),)
    }
    assert made["find it"] == canonical_text(read_form('(find (λ$1:e (is_a $1 "it")))'))
    assert made["follow it"] == canonical_text(read_form('(follow "it")'))


def test_a_description_of_which_nothing_is_left_is_unknown():
    lines = [each for each in NOTHING.templates if each.nonterminal == "where"]
    template = read_template("look $where = (look (λ$1:e (at $1 $where)))")
    alone = TaskCategory("1", NOTHING.grammar, (template, *lines))
    assert forms(alone)["look"] == "( look UNKNOWN )"
    assert {each.form_text for each in TemplateChart([alone]).parse("look")} == {"( look UNKNOWN )"}


def test_no_words_that_are_no_line_stay_unknown():
    plain = category(
        "go $where = (go $where)",
        grammar=Grammar(read_productions("$Main = go $where\n$where = away | {void}").productions),
    )
    assert forms(plain) == {"go": "( go UNKNOWN )", "go away": '( go " away " )'}


def test_a_line_keeps_its_nonterminal_and_prints_as_it_reads():
    line = read_template(PLACE)
    assert line.nonterminal == "do"
    assert read_template(print_template(line)) == line
    assert read_sides("$do -> stop", "(stop)")[0].nonterminal == "do"
    plain = read_template("$do \\-> stop = (stop)")
    assert plain.nonterminal == "" and print_template(plain) == "$do \\-> stop = (stop)"


@pytest.mark.parametrize(
    ("text", "column"),
    [("$do -> = (go)", 7), ("$do -> (a | b = (go)", 8), ("$do -> a {x y} = (go)", 10)],
)
def test_trouble_behind_the_arrow_has_its_place(text, column):
    with pytest.raises(LanguageError) as raised:
        read_template(text)
    assert raised.value.position.column >= column


def test_forms_of_lines_compose_and_sequences_are_flat():
    made = forms(ALL)
    assert made["walk to the <room>"] == '( go " <room> " )'
    assert (
        made["go to the <room> then put it on the <location>"]
        == '( sequence ( go " <room> " ) ( take it ) ( put it " <location> " ) )'
    )
    assert len(made) == generation_size([ALL]) == 10


def test_the_reader_leaves_a_sequence_in_a_sequence_alone():
    text = "( sequence ( go ) ( sequence ( stop ) ( go ) ) )"
    assert to_corpus(read_form(text)) == text


def test_words_that_no_line_derives_have_no_form():
    assert "go to the <room> and say hello" not in forms(ALL)


def test_the_later_line_wins_and_the_conflict_is_reported():
    later = category(BOTH, GOTO, THEN, BRING, '$do -> bring it to (me | us) = (hand it "me")')
    generated = generate([later])
    form = '( sequence ( go " <room> " ) ( hand it " me " ) )'
    assert forms(later)["go to the <room> then bring it to me"] == form
    assert len(generated.conflicts) == 2
    chart = TemplateChart([later])
    assert [each.form_text for each in chart.parse("go to the <room> then bring it to me")] == [
        form,
        '( sequence ( go " <room> " ) ( bring it ) )',
    ]


def test_wildcards_of_different_lines_are_different_and_those_of_one_line_the_same():
    rules = "$Main = x\n$a = to {room 1} or {room 1}\n$b = from {room 1}"
    one = category(
        "$a $b = (sequence $a $b)",
        "$a -> to {room 1} or {room 1} = (go {room 1})",
        "$b -> from {room 1} to {beacon} = (leave {room 1} {beacon})",
        grammar=Grammar(read_productions(rules).productions),
    )
    (derivation,) = TemplateExpander(one.grammar, one.lines).derivations(one.templates[0])
    first, again, other, beacon = (each for each in derivation.symbols if hasattr(each, "id"))
    assert first.identity == again.identity != other.identity
    written = to_template(derivation.form)
    assert written == (
        f"(sequence (go {{room {first.id}}}) (leave {{room {other.id}}} {{beacon {beacon.id}}}))"
    )


def test_a_nonterminal_without_lines_is_its_text_also_beside_one_with_lines():
    rules = "$Main = x\n$verb = bring | fetch\n$thing = the {kobject}"
    one = category(
        "$verb $thing = (do $thing $verb)",
        "$thing -> the {kobject} = (is_a {kobject})",
        grammar=Grammar(read_productions(rules).productions),
    )
    assert forms(one)["fetch the <object>"] == '( do ( is_a " <object> " ) " fetch " )'


@pytest.mark.parametrize(
    ("line", "others", "is_error", "place"),
    [
        ("$nowhere -> x = (go)", (), False, "$nowhere"),
        ("$do and go and $do = (sequence $do $do)", (BRING,), True, "$do ="),
        ("$do now = (go ($do it))", (BRING,), True, "$do it"),
        ("$goto $next = (go {name})", (), True, "{name}"),
        ("bring it to me = (bring it)", (), False, "(bring it)"),
    ],
)
def test_what_is_wrong_with_a_template_or_a_line_has_its_place(line, others, is_error, place):
    lines = tuple(map(read_template, (*others, line)))
    checker = template_checker(GRAMMAR, lines=tuple(each for each in lines if each.nonterminal))
    found = {(each.is_error, each.position.column) for each in checker.problems(lines[-1])}
    assert (is_error, line.index(place) + 1) in found


def test_a_line_that_nothing_reaches_and_two_forms_for_a_phrase_are_problems_of_their_lines():
    odd = category("$goto = $goto", GOTO, BRING, "$goto -> walk to the {room} = (walk {room})")
    assert [index for index, _ in line_problems(odd)] == [2, 3]
    assert {problem for _, problem in line_problems(odd)} <= set(
        set_problems([odd], generate([odd]))
    )
    assert not list(line_problems(ALL))


def test_lines_in_a_cycle_are_refused_with_their_place():
    cyclic = category("$do = $do", "$do -> then $next = $next", "$next -> and $do = $do")
    with pytest.raises(LanguageError) as raised:
        generate([cyclic])
    assert "$do" in raised.value.message and "$next" in raised.value.message


def test_the_form_of_a_line_in_the_place_of_another_kind_is_a_misuse():
    declared = infer_signatures(
        [read_form("(find (λ$1:e (is_a $1 {kobject})))"), read_form("(go {room})")]
    )
    lines = (read_template(GOTO),)
    checker = template_checker(GRAMMAR, declared, lines=lines)
    (problem,) = checker.problems(read_template("$goto = (find $goto)"))
    assert problem.position.column == len("$goto = (find ") + 1


@pytest.mark.parametrize(
    ("text", "loose"),
    [
        ("(put it {room})", ("it",)),
        ("(sequence (find {kobject}) (put it {room}))", ()),
        ('(sequence (find "<object>") (put it))', ()),
        ("(sequence (find (λ$1:e (near $1 (λ$2:e (person $2))))) (put it))", ()),
        ("(sequence (find (λ$1:e (person $1))) (follow them))", ()),
        ("(sequence (find (λ$1:e (person $1))) (put it))", ("it",)),
        ("(sequence (find (λ$1:e (is_a $1 {kobject}))) (put it) (follow them))", ("them",)),
        ('(sequence (find (λ$1:e (is_a $1 "<category>"))) (bring them))', ()),
        ('(sequence (go (λ$1:e (is_a $1 "<location>"))) (bring it))', ("it",)),
        ("(sequence (find (λ$1:e (person $1) (holds $1 {kobject}))) (take it))", ()),
        ("(bring {kobject} it)", ("it",)),
        ('(follow them "<room>")', ("them",)),
    ],
)
def test_a_reference_needs_something_described_before(text, loose):
    assert loose_references(read_form(text)) == loose


LINES = st.builds(
    lambda template, name: read_template(f"${name} -> {print_template(template)}"),
    small_templates(),
    st.sampled_from(["A", "B", "C"]),
)
COMMANDS = st.lists(st.lists(st.sampled_from(TOKENS), max_size=4), max_size=10)


@given(
    small_grammars(),
    st.lists(small_templates(), max_size=3),
    st.lists(LINES, max_size=3),
    st.booleans(),
    COMMANDS,
)
def test_parsing_is_the_inverse_of_generating(grammar, templates, lines, whole, others):
    if whole:
        templates = [*templates, read_template("$A $B = (sequence $A $B)")]
    one = TaskCategory("1", grammar, (*templates, *lines))
    try:
        assume(generation_size([one]) <= FEW)
    except LanguageError:  # a cycle through lines
        assume(False)
    generated = {each.command: each for each in generate([one]).expansions}
    chart = TemplateChart([one])
    for command, expansion in generated.items():
        kept = chart.parse(command)[0]
        assert kept.form_text == expansion.form_text
        assert kept.template_index == expansion.template_index
    for command in map(" ".join, others):
        assert bool(chart.parse(command)) == (command in generated)


@given(small_grammars(), st.lists(small_templates(), max_size=2), st.lists(LINES, max_size=3))
def test_what_is_surely_inside_is_all_derived_by_the_productions(grammar, templates, lines):
    own = [
        read_template(f"{print_sequence(each.expansion)} = (say)") for each in grammar.productions
    ]
    try:
        expander = TemplateExpander(grammar, tuple(lines))
        sizes = [expander.size(each) for each in (*templates, *own, *lines)]
    except LanguageError:  # a cycle through lines
        assume(False)
    assume(sum(sizes) <= FEW)
    for template in (*templates, *own, *lines):
        accepts = Recognizer(grammar, template.nonterminal or "Main").accepts
        said = {command for command, _ in expander.pairs(template)} - {""}
        if expander.rules.is_inside(template):
            assert all(map(accepts, said))


@pytest.mark.parametrize(
    ("pattern", "lines", "is_inside"),
    [
        ("$goto $next", [GOTO, FIND, THEN, PLACE], True),
        ("walk to the {room} (then $do | and say hello)", [PLACE], True),
        ("$goto", ["$goto -> run to the {room} = (go {room})"], False),
        ("$next", [], False),
    ],
)
def test_a_pattern_is_inside_where_the_productions_derive_it_as_it_is(pattern, lines, is_inside):
    read = tuple(map(read_template, lines))
    rules = TemplateExpander(GRAMMAR, read).rules
    assert rules.is_inside(read_template(f"{pattern} = (say)")) == is_inside


def steps(length, alternatives):
    """The steps of parsing ``length`` words that each of so many nonterminals reads in many ways."""
    names = [f"s{n}" for n in range(alternatives)]
    words = "{void} | a | a a | a a a"
    rules = "$Main = x\n" + "\n".join(f"${name} = {words}" for name in names)
    grammar = Grammar(read_productions(rules).productions)
    template = read_template(
        " ".join(f"${n}" for n in names) + f" = (go {' '.join(f'${n}' for n in names)})"
    )
    budget = Budget()
    TemplateChart([TaskCategory("1", grammar, (template,))]).parse(" ".join(["a"] * length), budget)
    return budget.spent


@pytest.mark.parametrize(("length", "alternatives"), [(6, 6), (10, 10)])
def test_steps_grow_polynomially_with_length_and_grammar(length, alternatives):
    """Doubling both multiplies the steps by at most 2⁵; readings themselves grow exponentially."""
    assert steps(2 * length, 2 * alternatives) <= 32 * steps(length, alternatives)


def test_a_line_is_laid_out_and_renamed_with_its_nonterminal():
    assert format_pattern("$do   ->  bring   it") == "$do -> bring it"
    assert format_form("$do") == "$do"
    for text in ("$do -> $do it", "$do -> $do (it"):  # the second one cannot be read
        renamed = rename_nonterminal_in_pattern(text, "do", "act")
        assert renamed == text.replace("$do", "$act")
    assert [place.start for place in places_in_pattern("$do -> $place it")] == [7]


ROOMS = Ontology(tuple(Entity("room", f"r{number}") for number in range(8)))


@pytest.mark.parametrize(
    ("rules", "lines"),
    [
        (
            "$x = go $p\n$y = walk $p\n$p = {room 1}",
            (
                "$x and $y = (sequence $x $y)",
                "$x -> go $p = (go {room 1})",
                "$y -> walk $p = (walk {room 1})",
            ),
        ),
        ("$p = {room 1}", ("$x = $x", "$x -> go $p from {room 1} = (go $p {room 1})")),
        ("$a = {room}\n$b = {room}", ("go from $a to $b = (go $b $a)",)),
        (
            "$a = {room}\n$b = {room}",
            ("$x = $x", "$x -> from $a to $b via {room} = (go $b {room} $a)"),
        ),
        ("$a = the {room}", ("go from $a to {room} = (go {room} {room} $a)",)),
        (
            "$a = {room 1}",
            (
                "$x to $y = (go $y $x)",
                "$x -> {room 1} or {room} = (or {room} {room 1})",
                "$y -> {room 1} or {room} = (or {room 1} {room})",
            ),
        ),
    ],
)
def test_generation_and_parsing_put_the_same_entities_into_the_same_slots(rules, lines):
    one = category(*lines, grammar=Grammar(read_productions(f"$Main = x\n{rules}").productions))
    chart = TemplateChart([one])
    reader = UtteranceReader(ROOMS, chart.vocabulary)
    for template in one.templates:
        for derivation in TemplateExpander(one.grammar, one.lines).derivations(template):
            if template.nonterminal:
                continue
            grounded = ground(derivation.symbols, derivation.form, ROOMS, Random(3))
            found = [
                filled_with(each, heard)
                for heard in reader.lattices(grounded.text)
                for each in chart.parse(heard.lattice)
            ]
            assert canonical_text(grounded.form) in found


def filled_with(derivation, heard):
    form = read_form(derivation.form_text)
    slots = with_values(FormSlots.of(form).slots, heard.values(derivation.arcs))
    return canonical_text(fill_all(form, slots).form).replace("the <room>", "the r0")


def test_optional_nonterminals_of_a_form_cost_no_more_than_others():
    def spent(count):
        names = [f"b{number}" for number in range(count)]
        rules = "$Main = x\n" + "\n".join(f"${name} = x" for name in names)
        pattern = " ".join(f"(${name} | x)" for name in names)
        template = read_template(f"go {pattern} = (go {' '.join(f'${name}' for name in names)})")
        budget = Budget()
        grammar = Grammar(read_productions(rules).productions)
        command = f"go {' '.join('x' * count)}"
        assert TemplateChart([TaskCategory("1", grammar, (template,))]).parse(command, budget)
        return budget.spent

    assert spent(24) <= 32 * spent(12)


@pytest.mark.parametrize(
    "utterance",
    [",", "-", "ok,", "please ", "please,", "go,", "a-b ", "\u0301", "<x>", "é’"],
)
def test_the_lattice_of_a_long_utterance_stays_in_proportion(utterance):
    reader = UtteranceReader(ROOMS, {"go", "to", "please", "ok", "ab", "<room>"})
    arcs = [
        sum(heard.lattice.n_arcs for heard in reader.lattices(utterance * count))
        for count in (400, 800)
    ]
    assert arcs[1] <= 3 * arcs[0] + 10


@pytest.mark.parametrize(
    ("rules", "lines"),
    [
        ("$thing = the big {room}", ("get $thing = (bring $thing)",)),
        ("$thing = the big {room 1}", ("$x = $x", "$x -> get $thing = (bring $thing)")),
        ("$thing = the big {room}", ("$x = $x", "$x -> get $thing = (bring $thing)")),
        (
            "$thing = the big {room}\n$b = {room}",
            ("get $thing from $b = (bring $b $thing)",),
        ),
        ("$thing = {room} by {room}", ("get $thing = (bring $thing)",)),
    ],
)
def test_a_text_of_a_form_has_the_entities_of_the_command(rules, lines):
    one = category(*lines, grammar=Grammar(read_productions(f"$Main = x\n{rules}").productions))
    template = one.templates[0]
    for derivation in TemplateExpander(one.grammar, one.lines).derivations(template):
        grounded = ground(derivation.symbols, derivation.form, ROOMS, Random(3))
        said = [
            word for word in grounded.text.split() if word.startswith("r") and word[1:].isdigit()
        ]
        written = canonical_text(grounded.form)
        assert "<" not in written
        assert sorted(each for each in written.split() if each in said) == sorted(said)


def test_lines_of_two_nonterminals_that_say_the_same_are_no_duplicates():
    one = category(
        "$goto $next = (sequence $goto $next)", "$goto -> go = (go)", "$next -> go = (go)"
    )
    assert not list(shared_problems(one, generate([one])))
    again = category("$goto = $goto", "$goto -> go = (go)", "$goto -> go = (go)")
    assert [index for index, _ in shared_problems(again, generate([again]))] == [2]
