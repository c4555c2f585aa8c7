"""An error on the command line shows its line with a caret."""

import pytest
from django.core.management import CommandError, call_command

pytestmark = pytest.mark.django_db


def test_an_error_of_an_import_shows_its_line_with_a_caret(tmp_path):
    (tmp_path / "gpsr.txt").write_text("$Main = go\n$a = find {objec 1}\n")
    with pytest.raises(CommandError) as refusal:
        call_command("import_generator", tmp_path, world="tiny")
    lines = str(refusal.value).split("\n")
    place = lines.index("    $a = find {objec 1}")
    assert lines[place - 1].startswith("gpsr.txt:2:12: error: there is no wildcard {objec}")
    assert lines[place + 1] == "               ^"


def test_an_error_of_the_folder_as_a_whole_stands_alone(tmp_path):
    (tmp_path / "names.xml").write_text("<names><name>Ada</name></names>")
    with pytest.raises(CommandError) as refusal:
        call_command("import_generator", tmp_path, world="tiny")
    assert str(refusal.value).startswith("error: there is no grammar here")
