"""How people log in: by password, and by single sign-on."""

from __future__ import annotations

from gpsr_site.settings.places import env

AUTH_USER_MODEL = "annotations.User"
SESSION_ENGINE = "annotations.models.people.sessions"
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
