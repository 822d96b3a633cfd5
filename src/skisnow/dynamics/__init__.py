"""Motion of a body on flexible skis over snow: implicit steps with error control, static equilibrium, energies."""

from .body import Body, BootMotion, BootPose, FlexibleSki
from .motion import Dynamics, Ended, StepControl

__all__ = ["Body", "BootMotion", "BootPose", "Dynamics", "Ended", "FlexibleSki", "StepControl"]
