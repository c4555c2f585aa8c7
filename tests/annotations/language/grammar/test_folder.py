"""Grammar files of a folder: encodings, imports, and which files make which task category."""

import pytest

from annotations.language.grammar import print_production, read_grammar_files
from annotations.language.templates import Composition
from annotations.language.templates.generator_folder import compose
from annotations.language.texts.decoding import MAX_FILES, read_folder
from annotations.language.texts.errors import LanguageError, Position


def folder_of(**texts):
    return read_grammar_files({f"{name}.txt": text.encode() for name, text in texts.items()})


def only_problem(contents):
    (problem,) = read_grammar_files(contents).problems
    return problem


@pytest.mark.parametrize("written", ["common.txt", '"common.txt"', "'COMMON.TXT'", "./common.txt"])
@pytest.mark.parametrize("name", ["common", "common_rules", "CommonRules"])
def test_common_stands_for_the_names_that_real_files_have(written, name):
    folder = folder_of(**{"main": f"; import {written}\n$Main = $x", name: "$x = a"})
    assert folder.problems == ()
    assert list(folder.grammar("main.txt").commands()) == ["a"]


def test_an_import_as_renames_the_root_of_the_imported_file():
    folder = folder_of(
        main="; import task.txt as $task\n$Main = please $task",
        task="$Main = go {void meta: or $Main} | $more\n$more = stay",
    )
    productions = [print_production(each) for each in folder.grammar("main.txt").productions]
    assert productions[0] == "$task = go {void meta: or $task} | $more"
    assert "$task" not in folder.files["task.txt"].productions[0].nonterminal


def test_a_file_under_two_names_is_taken_under_both():
    folder = folder_of(
        main="; import task.txt as $one\n; import task.txt as $two\n$Main = $one then $two",
        task="; import more.txt\n$Main = go",
        more="$Main = stay",
    )
    commands = set(folder.grammar("main.txt").commands())
    assert commands == {f"{one} then {two}" for one in ("go", "stay") for two in ("go", "stay")}


def test_files_that_import_each_other_are_taken_once():
    folder = folder_of(a="; import b.txt\n$Main = $x", b="; import a.txt\n; import b.txt\n$x = y")
    assert folder.problems == ()
    assert len(folder.grammar("a.txt").productions) == 2
    assert list(folder.grammar("a.txt").commands()) == ["y"]


@pytest.mark.parametrize(
    "path", ["../../etc/passwd", "/etc/passwd", "..\\common.txt", "C:\\rules.txt", "a/../../b.txt"]
)
def test_an_import_that_leaves_the_folder_is_an_error(path):
    problem = only_problem({"main.txt": f"\n; import {path}\n$Main = a".encode()})
    assert problem.is_error
    assert f" {path} " in problem.message
    assert problem.position == Position("main.txt", 2, 1)


def test_a_missing_import_is_an_error_with_its_place():
    problem = only_problem({"main.txt": b"$Main = a\n  ; import other.txt"})
    assert problem.is_error
    assert "other.txt" in problem.message
    assert problem.position == Position("main.txt", 2, 3)


@pytest.mark.parametrize(
    ("data", "named", "line", "column"),
    [
        ("$Main = a".encode("utf-16"), "UTF-16", 1, 1),
        ("$Main = a".encode("utf-16-le"), "UTF-16", 1, 2),
        (b"$Main = a\n$b = caf\xe9", "0xe9", 2, 9),
        (b"", "", 1, 1),
        (b"\xef\xbb\xbf \n\n", "", 1, 1),
        (b"\x89PNG\r\n\x1a\n\0\0", "0x89", 1, 1),
        (b"# only a comment", "", 1, 1),
        (b"bring me the cup\n( bring cup )\n", "", 1, 1),
    ],
)
def test_a_file_that_is_not_what_its_name_says_is_one_error_with_its_place(
    data, named, line, column
):
    problem = only_problem({"rules.txt": data})
    assert problem.is_error
    assert named in problem.message
    assert problem.hint
    assert problem.position == Position("rules.txt", line, column)


def test_line_ends_of_other_systems_are_line_ends():
    folder = read_grammar_files({"a.txt": b"$Main = $b\r\n$b = x\r$b = y"})
    assert list(folder.grammar("a.txt").commands()) == ["x", "y"]


def test_templates_and_the_text_files_of_the_ontology_are_no_grammars():
    names = ["a.txt", "a_semantics.txt", "categories.txt", "whattosay.txt", "objects.xml"]
    assert list(read_grammar_files(dict.fromkeys(names, b"$Main = a")).files) == ["a.txt"]


def test_a_folder_without_a_grammar_and_one_that_is_not_there_say_so(tmp_path):
    assert "no grammar" in read_grammar_files(read_folder(tmp_path)).problems[0].message
    with pytest.raises(LanguageError) as refused:
        read_folder(tmp_path / "nowhere")
    assert refused.value.source == "nowhere"


def test_a_link_out_of_the_folder_and_too_many_files_are_refused(tmp_path):
    outside = tmp_path / "outside.txt"
    outside.write_text("$Main = a")
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "link.txt").symlink_to(outside)
    with pytest.raises(LanguageError) as refused:
        read_folder(inside)
    assert refused.value.source == "link.txt"
    (inside / "link.txt").unlink()
    for number in range(MAX_FILES + 1):
        (inside / f"{number}.txt").touch()
    with pytest.raises(LanguageError, match=rf"\b{MAX_FILES + 1}\b"):
        read_folder(inside)


def compositions(*names, common=("common_rules",)):
    texts = dict.fromkeys(common, "$x = a") | dict.fromkeys(names, "$Main = a")
    grammars = [name for name in texts if not name.endswith("_semantics")]
    files = folder_of(**{name: texts[name] for name in grammars}).files
    return compose(files, [f"{name}.txt" for name in texts])


def test_category_two_uses_the_templates_of_one_and_its_own_and_three_only_its_own():
    stems = [f"gpsr_category_{n}_{kind}" for n in "123" for kind in ("grammar", "semantics")]
    assert compositions(*reversed(stems)) == (
        Composition("1", "gpsr_category_1_grammar.txt", ("gpsr_category_1_semantics.txt",)),
        Composition(
            "2",
            "gpsr_category_2_grammar.txt",
            ("gpsr_category_1_semantics.txt", "gpsr_category_2_semantics.txt"),
        ),
        Composition("3", "gpsr_category_3_grammar.txt", ("gpsr_category_3_semantics.txt",)),
    )


def test_other_files_with_a_main_are_named_by_their_stem_and_files_without_are_none():
    composed = compositions("gpsr", "egpsr_grammar", "gpsr_semantics", "category_2")
    assert [(each.name, each.template_files) for each in composed] == [
        ("2", ()),
        ("egpsr", ()),
        ("gpsr", ("gpsr_semantics.txt",)),
    ]


def test_templates_of_an_imported_file_come_before_the_own_ones():
    texts = {
        "words.txt": "$x = a",
        "kinds.txt": "; import words.txt\n$y = $x",
        "category_7_grammar.txt": "; import kinds.txt\n$Main = $y",
    }
    files = read_grammar_files({name: text.encode() for name, text in texts.items()}).files
    names = ("kinds_semantics.txt", "category_7_semantics.txt")
    (composed,) = compose(files, [*texts, *names])
    assert (composed.name, composed.template_files) == ("7", names)


def test_two_families_that_claim_one_number_keep_their_stems():
    composed = compositions("gpsr_category_1_grammar", "eegpsr_category_1_grammar")
    assert [each.name for each in composed] == ["eegpsr_category_1", "gpsr_category_1"]


def test_more_aliases_than_anybody_needs_are_an_error_at_their_place():
    def imports(n: int) -> bytes:
        lines = (f"; import b.txt as $x{number}\n" for number in range(n))
        return f"$Main = go\n{''.join(lines)}".encode()

    back = b"; import a.txt\n$Main = come\n"
    folder = read_grammar_files({"a.txt": imports(3), "b.txt": back})
    assert not folder.problems
    assert len(folder.sources("a.txt")) == 7
    (problem,) = read_grammar_files({"a.txt": imports(2_000), "b.txt": back}).problems
    assert (problem.position.source, problem.position.line) == ("a.txt", 22)


def test_imports_may_lead_through_many_files():
    files = {f"f{n}.txt": f"; import f{n + 1}.txt\n$n{n} = go\n".encode() for n in range(1_500)}
    files["f1500.txt"] = b"$Main = go\n"
    folder = read_grammar_files(files)
    assert folder.sources("f0.txt")[0] == ("f1500.txt", "")
