"""Every reader of skisnow, and the functions that open files of the program's own."""

from ..reader import Reader
from . import field, lab, motion, scenario, study, track

READERS: tuple[Reader, ...] = (
    *field.READERS, *track.READERS, *scenario.READERS, *study.READERS, *motion.READERS, *lab.READERS
)  # fmt: skip
BY_NAME = {reader.name: reader for reader in READERS}
