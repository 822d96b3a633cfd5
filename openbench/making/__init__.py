"""Cases, answers, drawings: every number of the set comes from here, by ``python -m openbench.making``."""
