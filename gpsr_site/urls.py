"""All pages and routes."""

from django.conf import settings
from django.contrib import admin
from django.contrib.auth.views import LogoutView
from django.urls import URLPattern, URLResolver, include, path

from annotations.people.access import WRITE, plain_view
from annotations.rest_urls import urlpatterns as corpus_routes
from annotations.web.campaigns import public_pages
from annotations.web.editing import comment_pages
from annotations.web.editing.draft_pages import my_drafts
from annotations.web.people import account_pages, own_account_pages
from annotations.web.people.audit_log_pages import site_log
from annotations.web.people.invitation_pages import join
from annotations.web.worlds import job_pages
from annotations.web.worlds.world_pages import world_import, world_new
from gpsr_site.accounts.password_pages import ChangePassword, LogIn, SetPassword
from gpsr_site.pages.document_pages import document, document_image, documents
from gpsr_site.pages.home_pages import banner, close_first_steps, favicon, healthz, home, world
from gpsr_site.pages.search import search, search_found
from parser_service.rest_urls import urlpatterns as parser_routes

API_ROUTES: list[URLPattern | URLResolver] = [*corpus_routes, *parser_routes]
# Nothing here is viewed on another site, and two free parts of an address take quadratic time to match.
ADMINISTRATION = [
    each for each in admin.site.get_urls() if getattr(each, "name", "") != "view_on_site"
]

urlpatterns = [
    path("", home, name="home"),
    path("login/", LogIn.as_view(), name="login"),
    path("logout/", plain_view(WRITE, does="log out")(LogoutView.as_view()), name="logout"),
    path("password/", ChangePassword.as_view(), name="password"),
    path("log/", site_log, name="site_log"),
    path("accounts/", account_pages.accounts, name="accounts"),
    path("accounts/<int:pk>/close/", account_pages.account_close, name="account_close"),
    path("accounts/<int:pk>/link/", account_pages.account_link, name="account_link"),
    path("password/<uidb64>/<token>/", SetPassword.as_view(), name="password_set"),
    path("account/", own_account_pages.account, name="account"),
    path("account/tokens/new/", own_account_pages.token_new, name="token_new"),
    path("account/tokens/<int:pk>/revoke/", own_account_pages.token_revoke, name="token_revoke"),
    path("account/sessions/end/", own_account_pages.sessions_end, name="sessions_end"),
    path("account/sessions/<slug:handle>/end/", own_account_pages.session_end, name="session_end"),
    path("join/<str:key>/", join, name="join"),
    path("p/<str:key>/", public_pages.campaign_begin, name="campaign"),
    path("p/<str:key>/done/", public_pages.campaign_done, name="campaign_done"),
    path("p/<str:key>/<int:position>/", public_pages.campaign_place, name="campaign_place"),
    path("p/<str:key>/<int:position>/check/", public_pages.campaign_check, name="campaign_check"),
    path("banner/", banner, name="banner"),
    path("favicon.ico", favicon, name="favicon"),
    path("healthz", healthz, name="healthz"),
    path("docs/", documents, name="documents"),
    path("docs/images/<str:name>", document_image, name="document_image"),
    path("docs/<slug:shelf>/<slug:page>/", document, name="document"),
    path("worlds/new/", world_new, name="world_new"),
    path("worlds/import/", world_import, name="world_import"),
    path("drafts/", my_drafts, name="my_drafts"),
    path("inbox/", comment_pages.inbox, name="inbox"),
    path("inbox/<int:pk>/", comment_pages.notice_open, name="notice_open"),
    path("jobs/<int:pk>/", job_pages.job, name="job"),
    path("jobs/<int:pk>/state/", job_pages.job_state, name="job_state"),
    path("jobs/<int:pk>/cancel/", job_pages.job_cancel, name="job_cancel"),
    path("jobs/<int:pk>/answer/", job_pages.job_answer, name="job_answer"),
    path("w/<slug:world>/", world, name="world"),
    path("w/<slug:world>/first-steps/", close_first_steps, name="first_steps"),
    path("w/<slug:world>/search/", search, name="search"),
    path("w/<slug:world>/search/found/", search_found, name="search_found"),
    path("w/<slug:world>/", include("annotations.urls")),
    path("w/<slug:world>/", include("parser_service.urls")),
    path("api/v1/", include((API_ROUTES, "api"))),
    path("admin/", (ADMINISTRATION, "admin", admin.site.name)),
]

if settings.SSO_SERVER_URL:
    urlpatterns.append(path("sso/", include("allauth.socialaccount.providers.openid_connect.urls")))

handler400 = "gpsr_site.web.error_pages.bad_request"
handler403 = "gpsr_site.web.error_pages.permission_denied"
handler404 = "gpsr_site.web.error_pages.not_found"
handler500 = "gpsr_site.web.error_pages.server_error"
