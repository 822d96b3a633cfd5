"""Force laws of snow on a tool or ski, one per file, one signature per family.

* `skisnow.forces.penetration`: the force of a tool pressed into snow, and the stress at one place on the snow.
* `skisnow.forces.shear`: the force at which snow fails sideways under an edge.
* `skisnow.forces.friction`: glide friction over the speed.
* `skisnow.forces.drag`: air drag.
* `skisnow.forces.cutting`: stress and thrust of machining theory, on which `shear.MachiningShear` rests.
"""
