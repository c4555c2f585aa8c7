"""Files of the size that an upload may have are read in a time that grows with their size."""

from __future__ import annotations

from annotations.exchange.generator_files import read_generator
from annotations.exchange.generator_import import import_generator
from annotations.generation.generating import generate_pairs
from annotations.models import World
from tests.work import growth, steps_of


def read_lines(number):
    lines = "".join(f"$a = find the thing number {each} in the room\n" for each in range(number))
    files = {"x.txt": b"$Main = $a\n" + lines.encode()}

    def read():
        assert not read_generator(files).all_problems

    return read


def test_the_lines_of_a_nonterminal_are_not_compared_each_with_each():
    assert growth(read_lines, 500) < 2.5


def test_a_nonterminal_with_ten_thousand_lines_is_read():
    read_lines(10_000)()


def test_2018_is_read_in_a_bounded_number_of_steps(shared_data):
    folder = shared_data / "generator-2018"
    files = {file.name: file.read_bytes() for file in folder.iterdir() if file.is_file()}
    assert steps_of(lambda: read_generator(files)) < 12_000_000


def test_2018_is_imported_and_generated_without_a_query_a_row(
    db, shared_data, django_assert_max_num_queries
):
    with django_assert_max_num_queries(100):
        import_generator("gpsr2018", shared_data / "generator-2018")
    with django_assert_max_num_queries(100):
        generate_pairs(World.objects.get())
