"""Entering tests: forms that store each reading at once, and what the readings say beside them."""
