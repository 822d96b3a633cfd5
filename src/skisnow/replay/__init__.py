"""Replay of a simulated run: its arrays, their compact binary format, and pages."""

from .from_run import replay_of_run
from .page import replay_bytes, replay_page, write_replay
from .replay import Replay, ReplayTrack, measured_track
from .run_file import replay_of_file
from .skier import joint_columns

__all__ = [
    "Replay",
    "ReplayTrack",
    "joint_columns",
    "measured_track",
    "replay_bytes",
    "replay_of_file",
    "replay_of_run",
    "replay_page",
    "write_replay",
]
