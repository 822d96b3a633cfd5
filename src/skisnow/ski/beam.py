"""Hermite bending and St-Venant torsion elements of a straight beam with stiffness that varies along it.

Degrees of freedom of an element between the nodes a and b: (w_a, w'_a, φ_a, w_b, w'_b, φ_b), w the deflection (m), w'
its slope, φ the twist (rad). Bending is Euler-Bernoulli with cubic Hermite shape functions, torsion is linear: bending
and torsion do not couple. Sources: any text on finite elements, Bathe (1996) *Finite element procedures* for one.
"""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass, fields, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.errors import ParameterError, require_range
from .ski import Ski

DOFS_PER_NODE: Final = 3
# four points integrate the square of a cubic times a linear density (degree 7) exactly
_POINT, _WEIGHT = np.polynomial.legendre.leggauss(4)
GAUSS_POINTS: Final[FloatArray] = (1.0 + _POINT) / 2.0
GAUSS_WEIGHTS: Final[FloatArray] = _WEIGHT / 2.0


def deflection_shape(local: npt.ArrayLike, length: npt.ArrayLike) -> FloatArray:
    """Shape functions of the deflection at the local coordinate 0 ≤ ζ ≤ 1 of elements of that length: (…, 6)."""
    z, h = np.broadcast_arrays(np.asarray(local, float), np.asarray(length, float))
    shape = np.zeros((*z.shape, 6))
    shape[..., 0] = (1.0 - z) ** 2 * (1.0 + 2.0 * z)
    shape[..., 1] = h * z * (1.0 - z) ** 2
    shape[..., 3] = z**2 * (3.0 - 2.0 * z)
    shape[..., 4] = h * z**2 * (z - 1.0)
    return shape


def slope_shape(local: npt.ArrayLike, length: npt.ArrayLike) -> FloatArray:
    """Derivative of `deflection_shape` along the beam (1/m): (…, 6)."""
    z, h = np.broadcast_arrays(np.asarray(local, float), np.asarray(length, float))
    shape = np.zeros((*z.shape, 6))
    shape[..., 0] = -6.0 * z * (1.0 - z) / h
    shape[..., 1] = (1.0 - z) * (1.0 - 3.0 * z)
    shape[..., 3] = 6.0 * z * (1.0 - z) / h
    shape[..., 4] = z * (3.0 * z - 2.0)
    return shape


def twist_shape(local: npt.ArrayLike) -> FloatArray:
    """Shape functions of the twist at the local coordinate 0 ≤ ζ ≤ 1: (…, 6)."""
    z = np.asarray(local, float)
    shape = np.zeros((*z.shape, 6))
    shape[..., 2] = 1.0 - z
    shape[..., 5] = z
    return shape


def curvature_shape(local: npt.ArrayLike, length: npt.ArrayLike) -> FloatArray:
    """Second derivative of `deflection_shape` along the beam (1/m²): (…, 6)."""
    z, h = np.broadcast_arrays(np.asarray(local, float), np.asarray(length, float))
    shape = np.zeros((*z.shape, 6))
    shape[..., 0] = (12.0 * z - 6.0) / h**2
    shape[..., 1] = (6.0 * z - 4.0) / h
    shape[..., 3] = (6.0 - 12.0 * z) / h**2
    shape[..., 4] = (6.0 * z - 2.0) / h
    return shape


def stiffness_matrices(
    length: FloatArray, bending_stiffness: FloatArray, torsional_stiffness: FloatArray
) -> FloatArray:
    """Stiffness matrices of the elements: (n, 6, 6).

    length: (n,) m, > 0.
    bending_stiffness, torsional_stiffness: (n, 4) EI and GJ (N m²) at the `GAUSS_POINTS` of each element.
    """
    stiffness = np.concatenate([bending_stiffness, torsional_stiffness], axis=1)
    return np.asarray(stiffness[:, None] @ _unit_stiffness(length.tobytes())).reshape(-1, 6, 6)


@functools.lru_cache(maxsize=8)
def _unit_stiffness(lengths: bytes) -> FloatArray:
    """Stiffness matrices for EI = 1 at each of the Gauss points, then GJ = 1: (n, 8, 36)."""
    length = np.frombuffer(lengths)
    curvature, weight = curvature_shape(GAUSS_POINTS[None, :], length[:, None]), GAUSS_WEIGHTS * length[:, None]
    out = np.zeros((len(length), 8, 6, 6))
    out[:, :4] = weight[:, :, None, None] * curvature[:, :, :, None] * curvature[:, :, None, :]
    out[:, 4:][:, :, [2, 5, 2, 5], [2, 5, 5, 2]] = (GAUSS_WEIGHTS / length[:, None])[:, :, None] * [
        1.0,
        1.0,
        -1.0,
        -1.0,
    ]
    return out.reshape(-1, 8, 36)


def mass_matrices(
    length: FloatArray, mass_per_length: FloatArray, torsional_inertia_per_length: FloatArray
) -> FloatArray:
    """Consistent mass matrices of the elements: (n, 6, 6).

    length: (n,) m, > 0.
    mass_per_length, torsional_inertia_per_length: (n, 4) kg/m and kg m at the `GAUSS_POINTS` of each element.
    """
    deflection = deflection_shape(GAUSS_POINTS[None, :], length[:, None])
    twist = twist_shape(GAUSS_POINTS)
    bending = np.einsum("g,n,ng,ngi,ngj->nij", GAUSS_WEIGHTS, length, mass_per_length, deflection, deflection)
    torsion = np.einsum("g,n,ng,gi,gj->nij", GAUSS_WEIGHTS, length, torsional_inertia_per_length, twist, twist)
    return np.asarray(bending + torsion)


HALF_BANDWIDTH: Final = 5
_CLOSE: Final = 1e-14  # by which share an eigenvalue still falls that is found
_MOST_ITERATIONS: Final = 200


def assembled(element_matrices: FloatArray, dof: IntArray, size: int) -> FloatArray:
    """Banded matrix (size, 11) of element matrices (n, 6, 6); `dof` (n, 6) numbers the unknowns, -1 where held."""
    free, place = _places_in_band(dof.tobytes())
    width = 2 * HALF_BANDWIDTH + 1
    return np.asarray(np.bincount(place, element_matrices[free], size * width), float).reshape(size, width)


@functools.lru_cache(maxsize=16)
def _places_in_band(dof: bytes) -> tuple[BoolArray, IntArray]:
    """Free entries of the element matrices, and their places in the banded matrix."""
    numbers = np.frombuffer(dof, np.int64).reshape(-1, 2 * DOFS_PER_NODE)
    rows, columns = np.broadcast_arrays(numbers[:, :, None], numbers[:, None, :])
    free = (rows >= 0) & (columns >= 0)
    return free, (2 * HALF_BANDWIDTH * rows + columns + HALF_BANDWIDTH)[free]


def lowest_eigenvalue(stiffness: FloatArray, mass: FloatArray, start: FloatArray) -> float:
    """Smallest λ of K x = λ M x in the span of the start, by subspace iteration.

    stiffness, mass: K and M (size, 11), symmetric and positive definite.
    start: where the iteration begins (size, k); it converges as (λ of the first over λ of the k + 1st)².
    """
    from scipy.linalg import cho_solve_banded, cholesky_banded, eigh

    factor = cholesky_banded(_columns(stiffness), lower=True, check_finite=False)
    force, eigenvalue = banded_product(mass, start), np.inf
    for _ in range(_MOST_ITERATIONS):
        shape = cho_solve_banded((factor, True), force, check_finite=False)
        moved = banded_product(mass, shape)
        values, mixed = eigh(shape.T @ force, shape.T @ moved, check_finite=False)
        before, eigenvalue = eigenvalue, float(values[0])
        if before - eigenvalue <= _CLOSE * eigenvalue:
            break
        force = moved @ mixed
    return eigenvalue


def _columns(matrix: FloatArray) -> FloatArray:
    """Lower half in LAPACK's storage: row k contains the k-th diagonal below the main one."""
    return np.array([np.roll(matrix[:, HALF_BANDWIDTH - k], -k) for k in range(HALF_BANDWIDTH + 1)])


def banded_product(matrix: FloatArray, vectors: FloatArray) -> FloatArray:
    """Banded matrix (size, 11) times vectors (size, k)."""
    around = np.pad(vectors, ((HALF_BANDWIDTH, HALF_BANDWIDTH), (0, 0)))
    rows = np.lib.stride_tricks.sliding_window_view(around, 2 * HALF_BANDWIDTH + 1, axis=0)
    return np.einsum("ij,ikj->ik", matrix, rows)


CLAMP_LENGTH: Final = 0.30
"""Length of ski that boot and binding keep straight (m). Modelling assumption: about a boot's sole; limits are tested
with 0."""
FINER: Final = 3.0
"""Times by which elements are shorter near the ends of the sidecut. There the ski begins and ends to bear, and its
twist bends within √(GJ u_y/(S_f e))/(W/2 sin ϑ), about 3 cm; within an element it is straight."""
END_SHARE: Final = 0.16
"""Share of the sidecut length, from either end inwards, over which they are shorter: up to where a rounded camber
makes the edge cut deepest."""
SHORT: Final = 0.01
"""Length (m) below which elements are not made shorter there, and no element is made beside such a zone."""
MOST_ELEMENTS: Final = 4000
"""Elements of 0.4 mm: finer ones would only cost time (modelling assumption)."""

STATION_POINTS: Final[FloatArray] = np.array([(1.0 - 1.0 / np.sqrt(3.0)) / 2.0, 1.0 - (1.0 - 1.0 / np.sqrt(3.0)) / 2.0])
"""Local coordinates of an element's two stations, its Gauss points of weight 1/2."""


_Zone = tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Stations:
    """Stations at which the snow acts: two Gauss points per element, tip to tail, also under the clamp.

    All arrays are (n,) except the shapes (n, 6) and `dof` (n, 6), which is -1 where the ski is clamped.
    """

    station: FloatArray
    weight: FloatArray
    width: FloatArray
    base_height: FloatArray
    dof: IntArray
    deflection: FloatArray
    slope: FloatArray
    twist: FloatArray


@dataclass(frozen=True, eq=False)
class ClampedSki:
    """Finite-element model of a ski whose clamped length is rigid, or on an elastic bed, and moves with the boot.

    ski, clamp_length: the ski and the length (m) that boot and binding keep straight, centred at the boot; 0: held at
        one section.
    node: positions of the nodes (m), tip to tail; the ends of the clamp are nodes.
    dof: (elements, 6) numbers of the unknowns, -1 where held.
    size: number of unknowns.
    stiffness: banded matrix (size, 11), relative to the boot.
    stations: see `Stations`.
    """

    ski: Ski
    clamp_length: float
    node: FloatArray
    dof: IntArray
    size: int
    stiffness: FloatArray
    stations: Stations

    @functools.cached_property
    def mass(self) -> FloatArray:
        """Banded mass matrix (size, 11) of motions relative to the boot."""
        at = self.ski.at(element_places(self.node, GAUSS_POINTS))
        inertia = at.mass_per_length * at.width**2 / 12.0
        matrices = mass_matrices(self.node[:-1] - self.node[1:], at.mass_per_length, inertia)
        return assembled(matrices, self.dof, self.size)


@functools.lru_cache(maxsize=32)
def clamped(
    ski: Ski, clamp_length: float, elements: int, footprint_stiffness: float | None = None, *, finer_ends: bool = False
) -> ClampedSki:
    """Divide a ski into about that many elements of equal length and clamp it at the boot.

    clamp_length: 0 ≤ length (m); it must lie within the ski.
    elements: ≥ 4, number of elements over the whole ski.
    footprint_stiffness: > 0, of boot and binding between the boot and each metre of the clamped length (N/m²): the ski
        is then held at the boot's middle and bedded on it over that length, with k W²/12 against twist; None: rigid.
    finer_ends: divide each element near the two ends of the sidecut into three, down to 1 cm.
    """
    front, rear = float(ski.station[0]), float(ski.station[-1])
    if not 0.0 <= clamp_length / 2.0 < min(front, -rear):
        raise ParameterError(
            "clamp_length is {clamp_length} m; it must be 0 or more and its half less than the distance from boot to "
            "tip and to tail ({front:.3f} and {value:.3f} m)"
        ).tag("out_of_range", clamp_length=clamp_length, front=front, value=-rear)
    require_range("elements", elements, 4)
    if footprint_stiffness is not None:
        require_range("footprint_stiffness", footprint_stiffness, 0.0, above=True)
    zones = _end_zones(ski, clamp_length) if finer_ends else ()
    node, dof, size, stations = _make_mesh(
        front, rear, clamp_length, elements, bedded=footprint_stiffness is not None, zones=zones
    )
    length = node[:-1] - node[1:]
    stiffness = stiffness_matrices(
        length, *ski.tables_at(element_places(node, GAUSS_POINTS), "bending_stiffness", "torsional_stiffness")
    )
    if footprint_stiffness is not None:  # as a mass, which resists in the same shapes
        under = np.where(np.abs(node[:-1] + node[1:]) < clamp_length, footprint_stiffness, 0.0)[:, None]
        (width,) = ski.tables_at(element_places(node, GAUSS_POINTS), "width")
        stiffness = stiffness + mass_matrices(length, under + 0.0 * width, under * width**2 / 12.0)
    width, base_height = ski.tables_at(element_places(node, STATION_POINTS), "width", "base_height")
    stations = replace(stations, width=width.ravel(), base_height=base_height.ravel())
    return ClampedSki(ski, clamp_length, node, dof, size, assembled(stiffness, dof, size), stations)


@functools.lru_cache(maxsize=16)
def _make_mesh(
    front: float, rear: float, clamp_length: float, elements: int, *, bedded: bool, zones: tuple[_Zone, ...]
) -> tuple[FloatArray, IntArray, int, Stations]:
    """Nodes, `dof`, `size` and stations of all skis from `front` to `rear` (m); without a clamp if `bedded`.

    The stations have no width and no base height yet.
    """
    node = _place_nodes(front, rear, clamp_length, elements, bedded=bedded, zones=zones)
    free = np.abs(node) > (0.0 if bedded else clamp_length) / 2.0 + 1e-12
    number = np.where(free, DOFS_PER_NODE * (np.cumsum(free) - 1), -DOFS_PER_NODE)
    of_node = number[:, None] + np.arange(DOFS_PER_NODE)
    of_node[~free] = -1
    dof, size = np.hstack([of_node[:-1], of_node[1:]]).astype(np.int64), int(DOFS_PER_NODE * free.sum())
    length = node[:-1] - node[1:]

    def flat(values: FloatArray) -> FloatArray:
        return np.ascontiguousarray(values.reshape(-1, *values.shape[2:]))

    # the elements run from tip to tail, against the station: the slope along the station has the other sign
    stations = Stations(
        station=flat(element_places(node, STATION_POINTS)),
        weight=np.repeat(length / 2.0, 2),
        width=np.zeros(0),
        base_height=np.zeros(0),
        dof=np.repeat(dof, 2, axis=0),
        deflection=flat(deflection_shape(STATION_POINTS, length[:, None])),
        slope=-flat(slope_shape(STATION_POINTS, length[:, None])),
        twist=np.tile(twist_shape(STATION_POINTS), (len(length), 1)),
    )
    for array in (node, dof, *(getattr(stations, field.name) for field in fields(Stations))):
        array.flags.writeable = False
    return node, dof, size, stations


def element_places(node: FloatArray, local: FloatArray) -> FloatArray:
    """Places (m), (elements, k), at local coordinates of each element; with rates of the nodes, rates of the places."""
    return np.asarray(node[:-1, None] - (node[:-1] - node[1:])[:, None] * local)


def model_nodes(front: float, rear: float, clamp_length: float, elements: int) -> FloatArray:
    """Nodes (m) of the model that `clamped` makes of a ski between these stations, whose clamp is rigid."""
    return _place_nodes(front, rear, clamp_length, elements, bedded=False)


def beam_rows(model: ClampedSki, station: npt.ArrayLike) -> tuple[IntArray, FloatArray, FloatArray]:
    """Numbers of the unknowns at stations (m), -1 if held, and shape functions of deflection and twist, (k, 6) each."""
    where = np.atleast_1d(np.asarray(station, float))
    element = np.clip(np.searchsorted(-model.node, -where, side="right") - 1, 0, len(model.dof) - 1)
    length = model.node[element] - model.node[element + 1]
    local = (model.node[element] - where) / length
    return model.dof[element], deflection_shape(local, length), twist_shape(local)


def base_motion(
    u: FloatArray, dof: IntArray, deflection: FloatArray, twist: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Deflection (m) and twist (rad) of the base for the unknowns u, by rows of `beam_rows`."""
    value = np.where(dof >= 0, u[dof], 0.0)
    return np.sum(deflection * value, axis=-1), np.sum(twist * value, axis=-1)


def beam_at_stations(model: ClampedSki, u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Deflection (m) and twist (rad) of the base relative to the boot at the model's stations, for the unknowns u."""
    stations = model.stations
    value = np.where(stations.dof >= 0, u[stations.dof], 0.0)
    return np.einsum("ij,ij->i", stations.deflection, value), np.einsum("ij,ij->i", stations.twist, value)


def _place_nodes(
    front: float, rear: float, clamp_length: float, elements: int, *, bedded: bool, zones: tuple[_Zone, ...] = ()
) -> FloatArray:
    """Stations of the nodes (m) from front to rear, with ends of clamp and zones, and closer nodes in zones."""
    half, spacing = clamp_length / 2.0, (front - rear) / elements
    places = {front, half, -half, rear, *((0.0,) if bedded else ()), *itertools.chain(*zones)}
    nodes = [np.array([front])]
    for start, end in itertools.pairwise(sorted(places, reverse=True)):
        is_fine = any(first >= start and end >= last for first, last in zones)
        finer = min(FINER, max(spacing / SHORT, 1.0)) if is_fine else 1.0
        nodes.append(np.linspace(start, end, max(1, round(finer * (start - end) / spacing)) + 1)[1:])
    return np.concatenate(nodes)


def _end_zones(ski: Ski, clamp_length: float) -> tuple[_Zone, ...]:
    """From the widest points of shovel and tail inwards, up to the clamp: first and last station (m) of each."""
    half = clamp_length / 2.0
    front, rear = (
        end if abs(end - widest) < SHORT else widest
        for end, widest in zip((ski.station[0], ski.station[-1]), ski.layout.widest_points, strict=True)
    )
    inner = END_SHARE * ski.sidecut_length
    ahead, behind = front - inner, rear + inner
    ahead, behind = half if ahead - half < SHORT else ahead, -half if -half - behind < SHORT else behind
    return (float(front), float(ahead)), (float(behind), float(rear))
