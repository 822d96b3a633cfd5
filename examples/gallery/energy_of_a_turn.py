"""Where the energy of a turn goes.

A sledge carves 46 m. What it loses in height becomes speed, heat of friction, air in
motion, and a groove in the snow. The simulation counts each by itself, so their sum
must be what there was at the start: a check on the whole computation.

Figure: the energies over time, stacked: kinetic, and all that was lost, against what
the height has given.
Known from: conservation of energy: gains and losses differ by less than a thousandth of
the energy exchanged.
"""

import matplotlib.pyplot as plt

import skisnow

run = skisnow.simulate(skisnow.load_scenario("carved-46m"))

height = -(run.energies["potential"] - run.energies["potential"][0])
gained = run.energies["kinetic"] - run.energies["kinetic"][0]
parts = {"speed gained": gained}
parts |= {
    f"lost to {name}": run.energies[name]
    for name in ("friction", "drag", "penetration", "shear", "damping")
}
stored = sum(
    run.energies[name] - run.energies[name][0]
    for name in ("elastic_ski", "elastic_snow")
)
open_by = (
    abs(height[-1] - sum(part[-1] for part in parts.values()) - stored[-1])
    / run.energy_exchanged
)
print(f"the height gave {height[-1]:.0f} J; the parts are off by {open_by:.1e} of it")
for name, part in parts.items():
    print(f"  {name:20} {part[-1]:7.0f} J")

figure, axes = plt.subplots()
axes.stackplot(run.time, list(parts.values()), labels=list(parts))
axes.plot(run.time, height, "--", color="black", label="given by the height")
axes.set(xlabel="time (s)", ylabel="energy (J)", xlim=(0, run.time[-1]))
axes.legend(loc="upper left")
figure.savefig("energy_of_a_turn.png")
