from tests.parser_service.conversing.conftest import parse_server, shelf  # noqa: F401
