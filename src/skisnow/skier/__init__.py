"""A skier on two legs: plans of turns, and a control that steers by the edge angle and keeps balance by the legs."""

from .balance import BalancedSkier, BalanceRecord, BalanceTuning
from .plan import TurnPlan

__all__ = ["BalanceRecord", "BalanceTuning", "BalancedSkier", "TurnPlan"]
