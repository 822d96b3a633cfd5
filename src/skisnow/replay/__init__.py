"""Replay of a simulated run: its arrays, their compact binary format, pages and glTF models."""

from .from_run import replay_of_run
from .model import moving_replay_model, replay_model
from .page import replay_bytes, replay_page, write_replay
from .replay import Replay, ReplayTrack, measured_track, ski_edges
from .run_file import replay_of_file
from .skier import joint_columns

__all__ = [
    "Replay",
    "ReplayTrack",
    "joint_columns",
    "measured_track",
    "moving_replay_model",
    "replay_bytes",
    "replay_model",
    "replay_of_file",
    "replay_of_run",
    "replay_page",
    "ski_edges",
    "write_replay",
]
