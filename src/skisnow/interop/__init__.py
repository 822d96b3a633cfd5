"""skisnow in other people's programs: what is written for them, and what is read of theirs."""
