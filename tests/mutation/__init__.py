"""Errors planted one at a time: how many of them do the tests of a package find? `python -m tests.mutation --help`."""
