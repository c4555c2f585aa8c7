"""Make and drop a database of PostgreSQL, named by its address."""

from __future__ import annotations

import sys

import psycopg


def create_database(address: str) -> None:
    """Create the database that an address names. Exits where there is one, which might hold something."""
    server, _, name = address.rpartition("/")
    with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
        try:
            connection.execute(f'CREATE DATABASE "{name}"')
        except psycopg.errors.DuplicateDatabase:
            sys.exit(f"There is a database {name} already; name another one.")


def drop_database(address: str) -> None:
    server, _, name = address.rpartition("/")
    with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
        connection.execute(f'DROP DATABASE "{name}" WITH (FORCE)')
