"""The second ski in the groove of the first.

Snow remembers. A board pressed 5 mm deep leaves a groove; a second one set into it
meets nothing until it is as deep as the groove, then a steep rise, and beyond the depth
of the first the law of untouched snow again.

Figure: force on the second board over its depth, beside the force in untouched snow.
Known from: closed form: at 4.75 mm p = H_V (5 mm) - k_u (0.25 mm), so F = 0.2 N/mm³ ·
2.5 mm · 60 mm · 1600 mm = 48 kN.
"""

import matplotlib.pyplot as plt
import numpy as np

import skisnow

board = skisnow.Runner(np.array([0.8, -0.8]), np.full(2, 0.03), np.zeros(2))
flat, still = np.eye(3)[None], np.zeros((1, 6))


def pressed(contact: skisnow.SnowContact, depth: float) -> float:
    """Force (N) on the board at a depth (m)."""
    return float(contact.force([[0.0, 0.0, -depth]], flat, still, 1e-3).wrench[0, 2])


def after(depth: float) -> skisnow.SnowContact:
    """A board lifted out of the groove that was pressed so deep (m)."""
    contact = skisnow.SnowContact(skisnow.SnowField(2e8, 3e5, 10.0), [board])
    for height in (0.0, -depth, 0.01):
        contact.update([[0.0, 0.0, height]], flat, 1e-3)
    return contact


depths = 1e-3 * np.linspace(0.0, 6.0, 241)
untouched = [pressed(after(0.0), depth) for depth in depths]
second = [pressed(after(5e-3), depth) for depth in depths]
at = pressed(after(5e-3), 4.75e-3)
print(f"at 4.75 mm {at / 1e3:.2f} kN; on untouched snow {0.2 * 4.75 * 60 * 1.6:.2f} kN")

figure, axes = plt.subplots()
axes.plot(1e3 * depths, 1e-3 * np.array(untouched), label="untouched snow")
axes.plot(1e3 * depths, 1e-3 * np.array(second), label="in a groove of 5 mm")
axes.set(xlabel="depth (mm)", ylabel="force (kN)", xlim=(0, 6), ylim=(0, None))
axes.legend()
figure.savefig("second_in_the_groove.png")
