"""Tables of the reports of a run, a turn, a course and an identification."""
