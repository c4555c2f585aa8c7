"""Load scripts: many clients against a real server. Run by hand; pytest collects none of them."""
