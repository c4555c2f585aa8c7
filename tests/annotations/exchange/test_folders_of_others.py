"""Folders of generators as they lie in repositories: read by directory, archive and upload, with warnings only."""

from __future__ import annotations

import io
import zipfile

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile

from annotations.exchange.gathered_files import GatheredFiles
from annotations.exchange.gathered_files import gather as files_of
from annotations.exchange.generator_export import generator_files
from annotations.exchange.generator_import import import_generator
from annotations.language.texts.errors import LanguageError
from annotations.models import Entity, Production, SemanticTemplate, World
from annotations.rows.from_rows import task_categories
from tests.annotations.exchange.folders_of_others import FOLDERS, LOCATIONS, OBJECTS

RULES = "$Main = go to the {room}\n"


def write(folder, files):
    for path, text in files.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(text.encode())


def packed(files) -> io.BytesIO:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for path, text in files.items():
            archive.writestr(path, text.encode())
    return data


def as_folder(files, tmp_path):
    write(tmp_path, files)
    return tmp_path


def as_archive(files, tmp_path):
    return files_of([SimpleUploadedFile("all.zip", packed(files).getvalue())])


WAYS = {"a folder": as_folder, "an archive": as_archive}


def test_names_of_files_are_normalised_as_the_imports_of_them_are(db):
    files = {"x/main.txt": "; import caf\u00e9.txt\n$Main = $x", "x/cafe\u0301.txt": "$x = go"}
    gathered = files_of({path: text.encode() for path, text in files.items()})
    assert set(gathered.files) == {"main.txt", "caf\u00e9.txt"}
    assert not import_generator("theirs", gathered).errors


def rows(name):
    """Return what the rows of a world say."""
    world = World.objects.get(name=name)
    return (
        list(
            Production.objects.filter(grammar__world=world).values_list(
                "source", "nonterminal", "expansion", "task_category"
            )
        ),
        list(
            SemanticTemplate.objects.filter(grammar__world=world).values_list(
                "source", "pattern", "form"
            )
        ),
        [
            (each.entity_class, each.text, each.attributes, each.source)
            for each in Entity.objects.filter(ontology__world=world)
        ],
        list(world.predicates.values_list("name", "kind", "signatures", "gloss")),
    )


def places(problems):
    return {(each.position.source, each.position.line) for each in problems}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", FOLDERS)
def test_it_imports_with_warnings_only_and_is_the_same_again(db, tmp_path, name, way):
    report = import_generator("theirs", WAYS[way](FOLDERS[name], tmp_path))
    assert report.errors == ()
    assert report.entities["object"] == 5 and report.entities["name"] == 3
    categories = task_categories(World.objects.get(name="theirs"))
    assert categories and all(any(each.grammar.commands()) for each in categories)

    world = World.objects.get(name="theirs")
    exported = {name: text.encode() for name, text in generator_files(world).items()}
    before = rows("theirs")
    again = import_generator("theirs", exported)
    assert not again.is_refused
    assert (again.changes.added, again.changes.removed) == (0, 0)
    assert rows("theirs") == before
    import_generator("copy", exported)
    assert rows("copy") == before


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("2015", {("Category2Grammar.txt", 1), ("FormatSpecification.txt", 1)}),
        ("2017", {("eegpsr_cat3e.txt", 10), ("eegpsr_cat3e.txt", 14)}),
        (
            "a team with notes",
            {("notes.txt", 1), ("bugs.txt", 1), ("requirements.txt", 1), ("gpsr.txt", 4)},
        ),
        (
            "a team with templates",
            {
                ("ours_category_1_slot.txt", 1),
                ("common_rules_slot.txt", 1),
                ("ours_category_2_semantics.txt", 1),
                ("grammar_ebnf.txt", 1),
            },
        ),
        (
            "a team with releases",
            {("2016/Objects.xml", 1), ("gen/Train.txt", 1), ("release-notes.txt", 1)},
        ),
    ],
)
def test_what_is_left_out_is_named_at_its_place(db, tmp_path, name, expected):
    report = import_generator("theirs", as_archive(FOLDERS[name], tmp_path))
    assert expected <= places(report.problems)


def test_a_kind_and_an_id_that_are_glued_together_are_a_kind_and_an_id(db, tmp_path):
    import_generator("theirs", as_archive(FOLDERS["a team with notes"], tmp_path))
    expansions = [each[2] for each in rows("theirs")[0]]
    assert expansions[0] == "bring {object 1} to {beacon 2}"
    assert expansions[1] == "swap {kobject 1} and {kobject 2} in the {room 1 meta: not {room 2}}"


@pytest.mark.parametrize("spell", [str.lower, str.upper, str.title, str.swapcase])
def test_known_names_are_known_in_any_case_of_letters(db, tmp_path, spell):
    files = FOLDERS["a team with templates"] | {
        "predicates.json": '[{"name": "greet", "kind": "action", "signatures": [["name"]], "gloss": "hi {1}"}]'
    }
    report = import_generator(
        "theirs", as_archive({spell(n): t for n, t in files.items()}, tmp_path)
    )
    assert report.errors == ()
    assert report.entities["whattosay"] == 2 and report.entities["question"] == 2
    assert sum(report.templates.values()) == 2 and sum(report.productions.values()) == 3
    assert (
        Entity.objects.get(entity_class="category", text="tools").attributes["singular"] == "tool"
    )
    assert World.objects.get(name="theirs").predicates.get(name="greet").gloss == "hi {1}"


def test_two_spellings_of_one_name_are_an_error_that_names_both(db):
    files = {
        "a.txt": RULES.encode(),
        "objects.xml": OBJECTS.encode(),
        "Objects.xml": b"<categories/>",
    }
    (problem,) = import_generator("theirs", files).errors
    assert problem.position.source == "objects.xml" and "Objects.xml" in problem.message


def test_of_two_files_with_one_name_the_nearer_is_taken_and_equal_ones_are_one():
    near, far = b"<categories/>", OBJECTS.encode()
    gathered = files_of({"x/y/Objects.xml": far, "x/objects.xml": near, "x/z/OBJECTS.XML": near})
    assert gathered.files == {"objects.xml": near}
    assert places(gathered.problems) == {("x/y/Objects.xml", 1)}
    assert not any(problem.is_error for problem in gathered.problems)
    (problem,) = files_of({"a/objects.xml": near, "b/Objects.xml": far}).problems
    assert problem.is_error and "a/objects.xml" in problem.message


class TestLinks:
    """A checkout has one ontology, and links to it; systems without links have a text in their place."""

    TARGET = "../../CommonFiles/Locations.xml"

    @pytest.fixture
    def checkout(self, tmp_path):
        write(
            tmp_path,
            {"repo/CommonFiles/Locations.xml": LOCATIONS, "repo/Tool/Resources/a.txt": RULES},
        )
        (tmp_path / "repo" / ".git").mkdir()
        return tmp_path / "repo"

    @pytest.fixture(params=["a link", "a text"])
    def linked(self, request, checkout):
        link = checkout / "Tool" / "Resources" / "Locations.xml"
        if request.param == "a link":
            link.symlink_to(self.TARGET)
        else:
            link.write_text(self.TARGET)
        return link

    def test_they_are_followed_inside_the_repository(self, db, checkout, linked):
        report = import_generator("theirs", linked.parent)
        assert report.problems == () and report.entities["room"] == 2

    def test_they_are_followed_below_the_folder_that_was_named(self, db, checkout, linked):
        (checkout / ".git").rmdir()
        assert import_generator("theirs", checkout).entities["room"] == 2
        (problem,) = import_generator("theirs", linked.parent).errors
        assert problem.position.source == "Locations.xml" and problem.hint

    @pytest.mark.parametrize("target", ["../../../outside.xml", "../../.git/x.xml", "/etc/hosts"])
    def test_none_leads_out_of_the_repository_or_into_hidden_folders(self, db, checkout, target):
        write(checkout.parent, {"outside.xml": LOCATIONS, "repo/.git/x.xml": LOCATIONS})
        link = checkout / "Tool" / "Resources" / "Locations.xml"
        link.symlink_to(target)
        assert places(import_generator("theirs", link.parent).errors) == {("Locations.xml", 1)}
        link.unlink()
        link.write_text(target)
        assert places(import_generator("theirs", link.parent).errors) == {("Locations.xml", 1)}

    def test_links_in_a_circle_end(self, db, checkout):
        folder = checkout / "Tool" / "Resources"
        (folder / "Locations.xml").write_text("./Names.xml")
        (folder / "Names.xml").write_text("./Locations.xml")
        problems = import_generator("theirs", folder).errors
        assert places(problems) & {("Locations.xml", 1), ("Names.xml", 1)}

    def test_an_archive_has_them_too_and_none_leaves_it(self):
        member = zipfile.ZipInfo("repo/Tool/Locations.xml")
        member.external_attr = 0o120777 << 16
        for target, is_there in (("../Common/Locations.xml", True), ("../../../etc/x.xml", False)):
            data = io.BytesIO()
            with zipfile.ZipFile(data, "w") as archive:
                archive.writestr(member, target)
                archive.writestr("repo/Common/Locations.xml", LOCATIONS)
            gathered = files_of([SimpleUploadedFile("a.zip", data.getvalue())])
            if is_there:
                assert gathered == GatheredFiles({"Locations.xml": LOCATIONS.encode()})
            else:
                assert [each.is_error for each in gathered.problems][:1] == [True]


@pytest.mark.parametrize(
    "text",
    [
        *(
            "",
            " \n\n",
            "# a comment",
            "Notes.\nNo rule = here.",
            "/* all of it */",
            "/* never closed",
        ),
        *("; grammar name X\n; grammar tier Easy", "\ufeff# with a mark\r\n"),
    ],
)
@pytest.mark.parametrize("name", ["HowTo.txt", "CHANGES.TXT", "x_slot.txt", "README.txt"])
def test_comments_and_prose_beside_a_grammar_are_a_warning(db, name, text):
    report = import_generator("theirs", {"a.txt": RULES.encode(), name: text.encode()})
    assert report.errors == () and report.productions == {"a.txt": 1}
    assert name.startswith("README") or places(report.problems) == {(name, 1)}


@pytest.mark.parametrize("name", ["a_semantics.txt", "whattosay.txt", "categories.txt"])
@pytest.mark.parametrize("send", ["page", "rest"])
def test_an_empty_file_is_a_warning_with_its_name(world, adam, name, send):
    files = [SimpleUploadedFile("a.txt", RULES.encode()), SimpleUploadedFile(name, b"")]
    address = "/w/home/import/" if send == "page" else "/api/v1/worlds/home/import/"
    answer = adam.post(address, {"files": files}, follow=True)
    assert answer.status_code == 200
    assert name in answer.content.decode()


@pytest.mark.parametrize("send", ["page", "rest"])
def test_an_empty_file_that_is_needed_is_an_error_with_its_name(world, adam, send):
    address = "/w/home/import/" if send == "page" else "/api/v1/worlds/home/import/"
    answer = adam.post(address, {"files": [SimpleUploadedFile("objects.xml", b"")]}, follow=True)
    is_refused = answer.context["is_refused"] if send == "page" else answer.status_code == 422
    assert is_refused
    assert "objects.xml" in answer.content.decode()


def test_all_errors_of_a_file_are_listed(db):
    grammar = "$Main = (a\n$b = {planet}\nhello\n$Main = c\n/* open\n"
    templates = "go = (go\nstay (stay)\nrun = \n"
    files = {"a.txt": grammar.encode(), "a_semantics.txt": templates.encode()}
    expected = {("a.txt", line) for line in (1, 2, 3, 5)} | {
        ("a_semantics.txt", line) for line in (1, 2, 3)
    }
    assert expected <= places(import_generator("theirs", files).errors)
    files["predicates.json"] = (
        b'[{"name": "a"},\n{"name": "b", "kind": "x", "signatures": []},\n{}]'
    )
    assert [
        each.position.line
        for each in import_generator("theirs", files).errors
        if each.position.source == "predicates.json"
    ] == [1, 2, 3]
    files["a.txt"] = b"$Main = (a\n$b = {planet}\nhello\n"  # not one line that can be read
    assert {("a.txt", 1), ("a.txt", 2), ("a.txt", 3)} <= places(
        import_generator("theirs", files).errors
    )


def test_a_grammar_whose_root_has_a_fault_is_not_left_out(db):
    files = {"a.txt": RULES.encode(), "b.txt": b"$Main = (x | y\n$z = {planet}\n"}
    assert places(import_generator("theirs", files).errors) == {("b.txt", 1), ("b.txt", 2)}
    assert not World.objects.exists()


def test_all_errors_of_several_files_are_listed(db):
    files = {
        "a.txt": b"$Main = go {nothing}\n$Main = (a | b\nno rule\n",
        "a_semantics.txt": b"go = (go\nfoo\n",
        "b.txt": b"$Main = x\n$y = (\n",
        "objects.xml": b"<categories><category name=></categories>",
        "names.xml": b"<names><name></names>",
    }
    expected = {("a.txt", 1), ("a.txt", 2), ("a.txt", 3), ("b.txt", 2), ("objects.xml", 1)}
    expected |= {("a_semantics.txt", 1), ("a_semantics.txt", 2), ("names.xml", 1)}
    assert places(import_generator("theirs", files).errors) == expected


@pytest.mark.parametrize("line", ["$x = |", "$x = || # nothing", "$x =|"])
def test_a_line_of_empty_alternatives_alone_is_left_out(db, line):
    report = import_generator("theirs", {"a.txt": f"{RULES}{line}\n".encode()})
    assert places(report.problems) == {("a.txt", 2)} and report.errors == ()


@pytest.mark.parametrize("way", WAYS)
def test_a_whole_checkout_is_read_whatever_else_it_holds(db, tmp_path, way):
    others = {f"repo/src/Module{n}.cs": f"class M{n} {{}}" for n in range(90)}
    others |= {f"repo/{name}/README.md": name for name in ("src", "doc")}
    others |= {f"repo/{name}/CMakeLists.txt": f"project({name})" for name in ("src", "doc")}
    others |= {"repo/README.md": "An example", "repo/readme.MD": "Another"}
    files = {"repo/gen/a.txt": RULES, "repo/gen/Objects.xml": OBJECTS, "repo/logo.bin": "x"}
    report = import_generator("theirs", WAYS[way](files | others, tmp_path))
    assert report.errors == () and report.entities["object"] == 5
    assert report.productions == {"a.txt": 1}


def test_an_archive_is_bounded_whatever_its_files_are_called(settings):
    many = packed({f"{n}.cs": "" for n in range(20_001)})
    with pytest.raises(LanguageError):
        files_of([SimpleUploadedFile("all.zip", many.getvalue())])
    settings.UPLOAD_MAX_BYTES = 1000
    link = packed({"objects.xml": "./other.xml", "other.xml": "a" * 1001, "a.txt": RULES})
    with pytest.raises(LanguageError):
        files_of([SimpleUploadedFile("all.zip", link.getvalue())])
    unread = packed({"big.bin": "a" * 1001, "a.txt": RULES})
    assert files_of([SimpleUploadedFile("all.zip", unread.getvalue())]).files["big.bin"] == b""


class TestLinksToFolders:
    @pytest.fixture
    def checkout(self, tmp_path):
        write(tmp_path, {"repo/common/Locations.xml": LOCATIONS, "repo/tool/a.txt": RULES})
        (tmp_path / "repo" / ".git").mkdir()
        return tmp_path / "repo"

    def test_they_are_followed_inside_the_repository(self, db, checkout):
        (checkout / "tool" / "common").symlink_to("../common")
        report = import_generator("theirs", checkout / "tool")
        assert report.problems == () and report.entities["room"] == 2

    def test_one_that_leads_out_is_left_out_with_a_warning(self, db, checkout):
        (checkout / ".git").rmdir()
        (checkout / "tool" / "common").symlink_to("../common")
        report = import_generator("theirs", checkout / "tool")
        assert report.errors == () and places(report.problems) == {("common", 1)}
        assert not report.entities.get("room")

    @pytest.mark.parametrize("target", [".", "..", "../tool"])
    def test_circles_end_and_folders_around_are_not_read(self, db, checkout, target):
        (checkout / "tool" / "again").symlink_to(target)
        report = import_generator("theirs", checkout / "tool")
        assert report.problems == () and not report.entities.get("room")


def test_links_that_lead_nowhere_are_errors_only_where_they_are_needed(db, tmp_path):
    write(tmp_path, {"a.txt": RULES})
    (tmp_path / "manual.pdf").symlink_to("gone.pdf")
    (tmp_path / "README.txt").symlink_to("/etc/hostname")
    assert import_generator("theirs", tmp_path).errors == ()
    (tmp_path / "objects.xml").symlink_to("objects.xml")
    (tmp_path / "names.xml").symlink_to("gone.xml")
    errors = import_generator("theirs", tmp_path).errors
    assert places(errors) == {("objects.xml", 1), ("names.xml", 1)}


def test_a_file_with_a_nul_is_no_link_and_is_named(tmp_path, db):
    write(tmp_path, {"main.txt": RULES, "other.txt": "a\0b.txt"})
    assert "other.txt" in {
        place for place, _ in places(import_generator("theirs", tmp_path).problems)
    }
