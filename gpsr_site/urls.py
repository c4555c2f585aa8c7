"""All pages and routes."""

urlpatterns: list = []
