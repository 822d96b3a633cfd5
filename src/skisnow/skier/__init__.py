"""A skier on two legs that pivot: observation and plan, control, and the body with its limits."""

from .anthropometry import Body, body_of
from .balance import BalancedSkier, BalanceRecord
from .control import Controller
from .posture import Command, Posture
from .seen import Seen

__all__ = ["BalanceRecord", "BalancedSkier", "Body", "Command", "Controller", "Posture", "Seen", "body_of"]
