from tests.parser_service.dialogues.conftest import parse_server, shelf  # noqa: F401
