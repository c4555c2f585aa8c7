"""An error on the command line shows its line with a caret."""

import pytest
from django.core.management import CommandError, call_command

from annotations.language.texts.errors import Position, warning_at
from annotations.management.base import ReportingCommand
from annotations.rows.stored_problems import as_json

pytestmark = pytest.mark.django_db


def test_an_error_of_an_import_shows_its_line_with_a_caret(tmp_path):
    (tmp_path / "gpsr.txt").write_text("$Main = go\n$a = find {objec 1}\n")
    with pytest.raises(CommandError) as refusal:
        call_command("import_generator", tmp_path, world="tiny")
    lines = str(refusal.value).split("\n")
    place = lines.index("    $a = find {objec 1}")
    assert lines[place - 1].startswith("gpsr.txt:2:12: error: ")
    assert "{objec}" in lines[place - 1]
    assert lines[place + 1] == "               ^"


def test_an_error_of_the_folder_as_a_whole_stands_alone(tmp_path):
    (tmp_path / "names.xml").write_text("<names><name>Ada</name></names>")
    with pytest.raises(CommandError) as refusal:
        call_command("import_generator", tmp_path, world="tiny")
    assert str(refusal.value).startswith("error: ")


def test_a_warning_of_no_file_is_printed_without_a_place():
    warning = warning_at(Position(), "no template covers it", "add one")
    elsewhere = warning_at(Position("a.txt", 2, 3), "nothing defines $a")
    report = {"problems": [as_json(warning), as_json(elsewhere)]}
    assert ReportingCommand().describe(report).split("\n")[1:] == [
        "  warning: no template covers it (add one)",
        "  a.txt:2:3: warning: nothing defines $a",
    ]
