"""What the commands of this project say of themselves."""

import pytest
from django.core.management import get_commands, load_command_class

OURS = sorted(
    name
    for name, app in get_commands().items()
    if app in ("annotations", "parser_service", "gpsr_site")
)


@pytest.mark.parametrize("name", OURS)
def test_each_says_what_it_does_and_what_it_takes(name):
    parser = load_command_class(get_commands()[name], name).create_parser("manage.py", name)
    assert parser.description
    assert name in parser.format_help()
