"""A skier on two legs: a control that steers by the edge angle, keeps balance by legs and edges, and its body."""

from .anthropometry import Body, body_of
from .balance import BalancedSkier, BalanceRecord
from .seen import Seen

__all__ = ["BalanceRecord", "BalancedSkier", "Body", "Seen", "body_of"]
