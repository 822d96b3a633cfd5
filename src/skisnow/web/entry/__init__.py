"""Entry of tests: forms that store each reading at once, and their results."""
