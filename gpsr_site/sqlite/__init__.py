"""The database backend for SQLite, which is the default database."""
