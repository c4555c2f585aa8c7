"""Other servers that are asked: the parse server, and one of a language model."""

from __future__ import annotations

from gpsr_site.secret_key import read_or_make_secret_key
from gpsr_site.settings.places import VAR_DIR, env
from gpsr_site.settings.serving import PORT

PARSER_HOST = env.str("PARSER_HOST", default="127.0.0.1")
PARSER_PORT = env.int("PARSER_PORT", default=PORT + 100 if PORT < 65_436 else PORT - 100)
# Where pages and REST ask; one that is named is on another machine, or started by somebody else.
PARSER_URL = env.str("PARSER_URL", default="")
PARSER_IS_ELSEWHERE = bool(PARSER_URL)
PARSER_URL = PARSER_URL or f"http://127.0.0.1:{PARSER_PORT}"
PARSER_SECRET = env.str("PARSER_SECRET", default="") or read_or_make_secret_key(
    VAR_DIR / "parser_secret"
)
# What runs that were asked but not promoted may take in the server's memory.
PARSER_MEMORY_MB = env.int("PARSER_MEMORY_MB", default=2_000)

# What the parser "llm" asks. The key is read here, and stands in no row and no log.
LLM_URL = env.str("GPSR_LLM_URL", default="").strip()
LLM_KEY = env.str("GPSR_LLM_KEY", default="").strip()
LLM_MAY_BE_REMOTE = env.bool("GPSR_LLM_REMOTE", default=False)
LLM_SECONDS = env.float("GPSR_LLM_SECONDS", default=120)
