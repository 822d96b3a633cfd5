"""Programs that enter the set, each with files alone; which of them there are stands in ``entries.json``."""
