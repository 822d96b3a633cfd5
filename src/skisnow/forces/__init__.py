"""Force laws of snow on a tool or ski, one per file, one signature per family.

* `skisnow.forces.penetration`: the force of a tool pressed into snow, and the stress at one place on the snow.
* `skisnow.forces.shear`: the force at which snow fails sideways under an edge, with stress and thrust of machining.
* `skisnow.forces.friction`: glide friction over the speed.
* `skisnow.forces.drag`: air drag.
"""
