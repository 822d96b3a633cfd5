"""Unit factors: multiply a number in the named unit to get SI; divide to go back.

The only place where 1 N/mm³ = 10⁹ N/m³ and its likes are written.

>>> 0.2 * N_PER_MM3
200000000.0
"""

from typing import Final

MM: Final = 1e-3
"""Metres in a millimetre."""
MM2: Final = 1e-6
"""Square metres in a square millimetre."""
MM3: Final = 1e-9
"""Cubic metres in a cubic millimetre."""
CM: Final = 1e-2
"""Metres in a centimetre."""
N_PER_MM: Final = 1e3
"""N/m in 1 N/mm, the unit of H_e."""
N_PER_MM2: Final = 1e6
"""N/m² in 1 N/mm², the unit of H_A and S_f."""
N_PER_MM3: Final = 1e9
"""N/m³ in 1 N/mm³, the unit of H_V."""
DEGREE: Final = 0.017453292519943295
"""Radians in a degree."""
