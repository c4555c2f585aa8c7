from tests.parser_service.serving.dialogues.conftest import parse_server, shelf  # noqa: F401
