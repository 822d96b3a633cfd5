"""A ski as a chain of Exudyn's ANCF cables, loaded statically.

Exudyn (Gerstmayr 2023, *Multibody System Dynamics* 60) is a multibody program. Its planar cables are geometrically
exact; its elements, assembly and static solver have nothing in common with ours.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import exudyn
import exudyn.utilities
import numpy as np

from skisnow._support.arrays import FloatArray
from skisnow.ski import Ski

ITEMS: Any = exudyn.utilities  # it is not typed
AXIAL_STIFFNESS = 1e5  # N: the ends slide freely, so its size does not matter
CABLES = 80  # of a cantilever
MOST_ROUNDS = 60
ALONG, ACROSS, SLOPE_ALONG, SLOPE_ACROSS = range(4)
"""Coordinates of a node: displacement along and across the ski, and of its slope vector."""


@dataclass(frozen=True)
class Chain:
    """Nodes (m, rising) joined by cables; Exudyn's system with its supports and loads."""

    system: Any
    place: FloatArray
    nodes: list[Any]
    ground: Any

    def marker(self, node: int, coordinate: int) -> Any:
        return self.system.AddMarker(ITEMS.MarkerNodeCoordinate(nodeNumber=self.nodes[node], coordinate=coordinate))

    def hold(self, node: int, *coordinates: int) -> None:
        for coordinate in coordinates:
            markers = [self.ground, self.marker(node, coordinate)]
            self.system.AddObject(ITEMS.CoordinateConstraint(markerNumbers=markers))

    def push(self, node: int, force: float) -> None:
        """Across the ski, away from the snow."""
        self.system.AddLoad(ITEMS.LoadCoordinate(markerNumber=self.marker(node, ACROSS), load=force))

    def spring(self, node: int, stiffness: float, surface: float) -> Any:
        """Pull and push the node towards `surface` (m)."""
        markers = [self.ground, self.marker(node, ACROSS)]
        return self.system.AddObject(
            ITEMS.CoordinateSpringDamper(markerNumbers=markers, stiffness=stiffness, offset=surface)
        )

    def solve(self, *, load_steps: int = 1) -> FloatArray:
        """Displacement of the nodes across the ski (m)."""
        settings: Any = exudyn.SimulationSettings()
        settings.solution.file.write = False
        settings.staticSolver.verboseMode = 0
        settings.staticSolver.numberOfLoadSteps = load_steps
        settings.staticSolver.newton.relativeTolerance = 1e-6  # at most: the last step of Newton's method squares it
        settings.staticSolver.newton.absoluteTolerance = 1e-8
        settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
        assert self.system.SolveStatic(settings)
        kind = exudyn.OutputVariableType.Displacement
        return np.array([self.system.GetNodeOutput(node, kind)[1] for node in self.nodes])


def chain(bending_stiffness: Callable[[FloatArray], FloatArray], place: FloatArray) -> Chain:
    """Cables between the places (m, rising), each with the bending stiffness at its middle."""
    container: Any = exudyn.SystemContainer()
    system = container.AddSystem()
    nodes = [system.AddNode(ITEMS.Point2DS1(referenceCoordinates=[x, 0.0, 1.0, 0.0])) for x in place]
    for i, stiffness in enumerate(bending_stiffness((place[:-1] + place[1:]) / 2.0)):
        system.AddObject(
            ITEMS.Cable2D(
                length=place[i + 1] - place[i],
                massPerLength=1.0,
                bendingStiffness=float(stiffness),
                axialStiffness=AXIAL_STIFFNESS,
                nodeNumbers=[nodes[i], nodes[i + 1]],
            )
        )
    ground = system.AddMarker(
        ITEMS.MarkerNodeCoordinate(nodeNumber=system.AddNode(ITEMS.NodePointGround()), coordinate=0)
    )
    return Chain(system, place, nodes, ground)


def cantilever_deflection(
    ski: Ski, start: float, end: float, station: FloatArray, force: FloatArray, *, scale: float = 1.0
) -> tuple[FloatArray, FloatArray]:
    """Places (m) and deflection (m) of the ski clamped at `start` under forces (N) at stations between it and `end`.

    Each force goes to its two neighbouring nodes by the lever rule. With a small `scale` the load is taken that much
    smaller and the answer that much larger: what is left is the linear deflection.
    """
    sign = 1.0 if end > start else -1.0
    distance = np.linspace(0.0, abs(end - start), CABLES + 1)
    beam = chain(lambda x: ski.at(start + sign * x).bending_stiffness, distance)
    beam.hold(0, ALONG, ACROSS, SLOPE_ALONG, SLOPE_ACROSS)
    x = sign * (station - start)
    beyond = x > 0.0
    cable = np.clip(np.searchsorted(distance, x[beyond], side="right") - 1, 0, CABLES - 1)
    share = (x[beyond] - distance[cable]) / (distance[1] - distance[0])
    nodal = np.zeros(CABLES + 1)
    np.add.at(nodal, cable, (1.0 - share) * force[beyond])
    np.add.at(nodal, cable + 1, share * force[beyond])
    for node in np.flatnonzero(nodal):
        beam.push(int(node), scale * float(nodal[node]))
    beam.system.Assemble()
    return start + sign * distance, beam.solve(load_steps=1 if scale < 0.1 else 4) / scale


@dataclass(frozen=True)
class OnSnow:
    """A ski on springs that do not pull: built once, solved by an active set."""

    beam: Chain
    springs: list[Any]
    base_height: FloatArray

    def depth(self) -> tuple[FloatArray, int]:
        """Depth of the base at the nodes (m), and the number of solutions it took."""
        system = self.beam.system
        active = np.ones(len(self.springs), bool)
        for round_ in range(MOST_ROUNDS):
            for spring, on in zip(self.springs, active, strict=True):
                system.SetObjectParameter(spring, "activeConnector", bool(on))
            depth = -(self.beam.solve() + self.base_height)
            pressed = depth > 0.0
            if np.array_equal(pressed, active):
                return depth, round_ + 1
            active = pressed
        raise AssertionError("the contact did not settle")


def on_snow(ski: Ski, hardness: float, load: float, *, elements: int = 160) -> OnSnow:
    """A flat ski under a point load at the boot on snow of H_V (N/m³): springs of H_V · width · length at the nodes."""
    tip, tail = float(ski.station[0]), float(ski.station[-1])
    behind = max(2, round(-tail / (tip - tail) * elements))
    place = np.concatenate([np.linspace(tail, 0.0, behind + 1)[:-1], np.linspace(0.0, tip, elements - behind + 1)])
    beam = chain(lambda x: ski.at(x).bending_stiffness, place)
    beam.hold(behind, ALONG)
    beam.push(behind, -load)
    at = ski.at(place)
    length = np.gradient(place)
    length[[0, -1]] /= 2.0
    springs = [
        beam.spring(i, hardness * float(at.width[i]) * float(length[i]), -float(at.base_height[i]))
        for i in range(len(place))
    ]
    beam.system.Assemble()
    return OnSnow(beam, springs, at.base_height)
