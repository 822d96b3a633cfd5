"""Exact derivatives of a carve by the adjoint state: how an output grows with ski, snow, load and edge angle.

Names with `growth` are derivatives. Equations: docs/methods/carved-turn.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import DEGREE, N_PER_MM2, N_PER_MM3
from ..parameters import suggest_and_list
from ..ski.beam import clamped
from ..ski.editing import LINEAR, shape_parameters, shape_value, table_growths, varied_ski
from .outputs import OUTPUTS, CarveRequest, OutputGrowth, output_growth
from .shape import Shape, ShapeGradient, beam_gradients, bent_by, growth_by_tables, shape_growth, widest_station
from .solve import Solution, refined, solved

if TYPE_CHECKING:
    from ..compiled import core
    from ..ski.beam import ClampedSki
    from ..snow.properties import SnowProperties


CONDITIONS: Final = (
    "edge_angle_deg", "load_N", "moment_Nm", "unloading_ratio", "snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2",
)  # fmt: skip
"""Parameters besides those of the ski. Load and edge angle change the side force, load × tan ϑ, with them."""
AT_KINK: Final = 1e-6
"""Relative distance to a kink below which a derivative has two values."""
_BESIDE: Final = 1e-9  # relative change of the parameter, behind twice the distance, at which they are taken
_IN_CONDITIONS: Final = (
    "edge_angle", "hardness", "excess", "load", "moment", "side_force", "bevel", "bevel_width", "pitch_of_force",
    "pitch_of_shear", "side", "radius",
)  # fmt: skip
"""Numbers of the core that are conditions, in its order but for the two that follow the pitch."""
_ANGLE, _HARDNESS, _EXCESS, _LOAD, _MOMENT, _SIDE_FORCE, _BEVEL, _BEVEL_WIDTH, _PITCH, _PITCH_OF_SHEAR = range(10)
_RUNNING, _WIDEST, _SIDE, _RADIUS, _COUNT = range(10, 15)
_OF_CONDITIONS: Final = [*range(_RUNNING), _SIDE, _RADIUS]
_OF_SHAPE: Final = [_RUNNING, _BEVEL, _BEVEL_WIDTH, _SIDE, _RADIUS]  # of the ski: those of `TableGrowth`


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """Derivative of an output by a parameter.

    output, parameter: Names, with their units.
    output_value, parameter_value: Values at the equilibrium.
    derivative: Units of the output per unit of the parameter.
    relative: Change of the output in % per % of the parameter; None where either is 0.
    kink: Relative change of the parameter at which a station touches or leaves the snow or the groove, to first order:
        beyond it the derivative is another.
    one_sided: Where the kink is nearer than `AT_KINK`: the derivatives just below and just above the parameter; None on
        a side without an equilibrium.
    """

    output: str
    parameter: str
    output_value: float
    parameter_value: float
    derivative: float
    relative: float | None
    kink: float
    one_sided: tuple[float | None, float | None] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class _ParameterDerivatives:
    """Derivatives of the equations' inputs (conditions, strength, ski) by one parameter, per its unit."""

    numbers: FloatArray
    strength: float = 0.0
    shape: Shape | None = None

    def columns(self, model: ClampedSki) -> FloatArray:
        """Derivatives of place, weight, width and base height of the stations, and of ln(element length)."""
        if self.shape is None:
            return np.zeros((5, len(model.stations.station)))
        stretch = self.shape.length / (model.node[:-1] - model.node[1:])
        return np.array(
            [self.shape.place, np.repeat(self.shape.length / 2.0, 2), *self.shape.sections, np.repeat(stretch, 2)]
        )


@dataclass(slots=True, eq=False)
class _Gradient:
    """An output, and its derivatives by the numbers of the equations.

    `columns`: by place, weight, width, base height of the stations; `numbers`: by the conditions; `adjoint`: adjoint
    unknowns of the beam; `by_tables`: by the ski's tables, None before they are computed.
    """

    output: OutputGrowth
    columns: FloatArray
    numbers: FloatArray
    adjoint: FloatArray
    by_tables: FloatArray | None = None


@dataclass(slots=True, eq=False)
class CarveDerivatives:
    """Derivatives at one equilibrium; quantities that several outputs and parameters need are computed once.

    request: The request of a carve with the groove along the edge and numbers for the snow.
    at: The same with its solution to the last digits.
    """

    request: CarveRequest
    point: core.CarvePoint = field(init=False)
    at: CarveRequest = field(init=False)
    _directions: dict[str, _ParameterDerivatives] = field(default_factory=dict)
    _neighbours: dict[tuple[str, float], CarveDerivatives | None] = field(default_factory=dict)
    _outputs: dict[str, OutputGrowth | None] = field(default_factory=dict)
    _gradients: dict[str, _Gradient] = field(default_factory=dict)

    def __post_init__(self) -> None:
        request = self.request
        self.point = refined(request.model, request.conditions, request.solution)
        _, u, (depth, slope, stress), edge_depth, force = self.point.state()
        solution = Solution(True, 0, u, depth, slope, stress, edge_depth, force)
        self.at = replace(request, solution=solution)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of all parameters by which outputs can be differentiated."""
        return (*CONDITIONS, *shape_parameters(self.request.model.ski))

    @property
    def everyday_parameters(self) -> tuple[str, ...]:
        """Names of the most used parameters: turn, snow, widths, camber, factors of sidecut and stiffness."""
        factors = ("edit.sidecut_depth", "edit.EI_N_m2", "edit.GJ_N_m2")
        everyday = (*CONDITIONS, *(f"ski.{key}" for key in LINEAR), *factors)
        return tuple(name for name in self.parameters if name in everyday)

    def value(self, parameter: str) -> float:
        """Value of a parameter, in the unit of its name."""
        conditions = self.request.conditions
        values = {
            "edge_angle_deg": conditions.edge_angle / DEGREE,
            "load_N": conditions.load,
            "moment_Nm": conditions.moment,
            "unloading_ratio": 1.0 + conditions.excess / conditions.hardness,
            "snow.H_V_N_per_mm3": conditions.hardness / N_PER_MM3,
            "snow.S_f_N_per_mm2": (self.request.strength or 0.0) / N_PER_MM2,
        }
        if parameter in values:
            return values[parameter]
        if parameter.partition(".")[0] not in ("ski", "edit"):
            raise ParameterError("unknown parameter of a carve: {name}. {allowed}").tag(
                "unknown_name", name=parameter, allowed=suggest_and_list(parameter, self.parameters)
            )
        return shape_value(self.request.model.ski, parameter)

    def sensitivity(self, output: str, parameters: Iterable[str], *, kinks: bool = True) -> tuple[Sensitivity, ...]:
        """Derivatives of an output by parameters; `kinks`: whether the distances to them are computed, else infinite.

        Raises ParameterError: an output or a parameter is unknown, or the output does not exist here.
        """
        of_output, out = self._gradient(output).output.value, []
        values = {name: self.value(name) for name in parameters}
        growths = self.derivatives(output, (*values,)).tolist()
        for (name, value), growth in zip(values.items(), growths, strict=True):
            relative = growth * value / of_output if value and of_output else None
            has_kink = kinks and name != "snow.S_f_N_per_mm2"
            kink = self._growth(name)[4] / (abs(value) or 1.0) if has_kink else math.inf
            step = (2.0 * kink + _BESIDE) * (abs(value) or 1.0)
            sides = (self._beside(name, -step, output), self._beside(name, step, output)) if kink < AT_KINK else None
            out.append(Sensitivity(output, name, of_output, value, growth, relative, kink, sides))
        return tuple(out)

    def _beside(self, name: str, change: float, output: str) -> float | None:
        """Derivative of an output after a relative change of the parameter; None without equilibrium or output."""
        if (name, change) not in self._neighbours:
            self._neighbours[name, change] = self._moved(name, change)
        neighbour = self._neighbours[name, change]
        if neighbour is None or neighbour.output(output) is None:
            return None
        return neighbour.derivative(output, name)

    def _moved(self, name: str, change: float) -> CarveDerivatives | None:
        """The derivatives at a neighbouring equilibrium, with the parameter changed; None if it is not found."""
        request, direction = self.request, self._parameter_derivatives(name)
        given, model = request.conditions, request.model
        numbers = zip(_IN_CONDITIONS, direction.numbers[_OF_CONDITIONS], strict=True)
        given = given._replace(**{key: getattr(given, key) + change * float(growth) for key, growth in numbers})
        if given.excess < 0.0 or given.edge_angle < 0.0:
            return None
        if name not in CONDITIONS:
            model = clamped(varied_ski(model.ski, name, change), model.clamp_length, request.elements)
        near = self.at.solution if model.size == request.model.size else None
        solution = solved(model, given, near=near)
        strength = None if request.strength is None else request.strength + change * direction.strength
        if not solution.converged:
            return None
        return CarveDerivatives(CarveRequest(model, given, strength, solution, request.elements))

    def output(self, name: str) -> float | None:
        """Value of an output, in the unit of its name; None where it does not exist."""
        growth = self._output(name)
        return None if growth is None else growth.value

    def half_interval(self, output: str, snow: SnowProperties) -> float | None:
        """Half the 95 % interval of an output by those of H_V and S_f, to first order; None if they lack one."""
        halves = self.changes_by_snow(output, snow)
        return math.hypot(*halves) if halves else None

    def changes_by_snow(self, output: str, snow: SnowProperties) -> list[float]:
        """Change of an output with half the interval of H_V and half that of S_f, of those that have an interval."""
        growth = {
            "snow.H_V_N_per_mm3": (snow.snow_hardness_interval, N_PER_MM3),
            "snow.S_f_N_per_mm2": (snow.failure_shear_stress_interval, N_PER_MM2),
        }
        return [
            self.derivative(output, name) * (interval[1] - interval[0]) / 2.0 / unit
            for name, (interval, unit) in growth.items()
            if interval is not None
        ]

    def force_growth(self, parameter: str) -> FloatArray:
        """Derivatives of the force per length at each station (N/m) by a parameter, per its unit."""
        return self._growth(parameter)[3]

    def force_at(self, place: FloatArray) -> FloatArray:
        """Force per length (N/m) of the equilibrium itself at places (m), linear between the stations."""
        return np.interp(place, self._rising_stations, self.at.solution.force_per_length[::-1])

    def force_growth_at(self, parameter: str, place: FloatArray) -> FloatArray:
        """Derivatives of `force_at` by a parameter, per its unit; stations may move with it."""
        force, rising = self.at.solution.force_per_length[::-1], self._rising_stations
        shape = self._parameter_derivatives(parameter).shape
        out = np.interp(place, rising, self.force_growth(parameter)[::-1])
        if shape is None or not shape.moves:
            return out
        row = np.clip(np.searchsorted(rising, place) - 1, 0, len(rising) - 2)
        slope = (np.diff(force) / np.diff(rising))[row]
        return np.asarray(out - slope * np.interp(place, rising, shape.place[::-1]))

    @property
    def _rising_stations(self) -> FloatArray:
        """Stations (m) in rising order, from tail to tip."""
        return self.request.model.stations.station[::-1]

    def fields(self, output: str) -> dict[str, FloatArray]:
        """Derivatives of an output by the curves of the ski, per metre of ski.

        With width and base height (mm) at ``station_m``, and with EI and GJ (N m²) at ``beam_m``.
        """
        gradient, model = self._gradient(output), self.request.model
        columns, (bending, torsion) = gradient.columns, self._by_stiffness(gradient)
        length = model.node[:-1] - model.node[1:]
        weight = model.stations.weight
        return {
            "station_m": model.stations.station,
            "width_per_mm_m": columns[2] / weight * 1e-3,
            "base_height_per_mm_m": columns[3] / weight * 1e-3,
            "beam_m": (model.node[:-1] + model.node[1:]) / 2.0,
            "EI_per_N_m3": bending.sum(axis=1) / length,
            "GJ_per_N_m3": torsion.sum(axis=1) / length,
        }

    def _output(self, output: str) -> OutputGrowth | None:
        """Value and derivatives of an output, None if it does not exist; rejects an unknown name."""
        if output not in OUTPUTS:
            raise ParameterError("unknown output, or one without derivatives: {name}. {allowed}").tag(
                "unknown_name", name=output, allowed=suggest_and_list(output, OUTPUTS)
            )
        if output not in self._outputs:
            self._outputs[output] = output_growth(output, self.at)
        return self._outputs[output]

    def _gradient(self, output: str) -> _Gradient:
        """Derivatives of an output by the equations' quantities; rejects an output without a value."""
        growth, model = self._output(output), self.request.model
        if growth is None:
            raise ParameterError("the carve has no {output}, so it has no derivative.").tag("no_value", output=output)
        if output not in self._gradients:
            none = np.zeros(len(self.at.solution.edge_depth))
            depth, force = (none if part is None else part for part in (growth.depth, growth.force))
            columns, numbers, adjoint = self.point.gradient(growth.by_unknowns(model), depth, force)
            self._gradients[output] = _Gradient(growth, columns, numbers, adjoint)
        return self._gradients[output]

    def _by_stiffness(self, gradient: _Gradient) -> FloatArray:
        """Derivatives of an output by EI and GJ at the Gauss points (2, n, 4)."""
        return beam_gradients(self.request.model, self.at.solution.u[None], gradient.adjoint[None])[0]

    def derivative(self, output: str, name: str) -> float:
        """Derivative of an output by a parameter, in units of the output per unit of the parameter.

        Raises ParameterError: as `sensitivity`.
        """
        return float(self.derivatives(output, (name,))[0])

    def derivatives(self, output: str, names: tuple[str, ...]) -> FloatArray:
        """Derivatives of an output by each parameter, per its unit, all from one solution of the adjoint equations."""
        gradient, out = self._gradient(output), np.zeros(len(names))
        growth, of_ski = gradient.output, tuple(name for name in names if name not in CONDITIONS)
        for row, name in enumerate(names):
            if name in CONDITIONS:
                along = self._parameter_derivatives(name)
                by_state = growth.edge_angle * along.numbers[_ANGLE] + growth.load * along.numbers[_LOAD]
                out[row] = gradient.numbers @ along.numbers + growth.strength * along.strength + by_state
        if of_ski:
            out[[name not in CONDITIONS for name in names]] = ski_derivatives([(self, output)], of_ski)[0]
        return out

    def by_tables(self, output: str) -> FloatArray:
        """Derivatives of an output by station, width, base height, EI and GJ of each table row, shape (5, rows)."""
        gradient, model, u = self._gradient(output), self.request.model, self.at.solution.u
        growth = gradient.output
        if gradient.by_tables is None:
            columns = gradient.columns.copy()
            for row, by in enumerate((growth.place, growth.weight)):
                columns[row] += 0.0 if by is None else by
            # the shapes of slopes are as long as the element
            columns[4] *= _slopes_at_stations(model, u)
            columns[5] *= -_slopes_at_stations(model, gradient.adjoint)
            stiffness, widest = self._by_stiffness(gradient), gradient.numbers[_WIDEST]
            shape = ShapeGradient(columns, stiffness, widest, growth.edge, growth.edge_by)
            gradient.by_tables = shape.by_tables(model, self.request.elements, u, gradient.adjoint)
        return gradient.by_tables

    def _growth(self, name: str) -> tuple[FloatArray, tuple[float, float, float], FloatArray, FloatArray, float]:
        """Derivatives by a parameter of unknowns, boot depth, slope and shear, edge depth, force; and kink distance."""
        direction, model = self._parameter_derivatives(name), self.request.model
        bent = np.zeros(model.size)
        if direction.shape is not None:
            bent = bent_by(model, self.at.solution.u, direction.shape)
        return self.point.growth(direction.columns(model), direction.numbers, bent)

    def _parameter_derivatives(self, name: str) -> _ParameterDerivatives:
        """Derivatives of the equations' numbers and of the ski's shape by a parameter."""
        if name not in self._directions:
            if name in CONDITIONS:
                self._directions[name] = self._condition_derivatives(name)
            else:
                request = self.request
                shape = shape_growth(request.model.ski, name, request.model.clamp_length, request.elements)
                numbers = np.zeros(_COUNT)
                numbers[[_RUNNING, _WIDEST, *_OF_SHAPE[1:]]] = shape.numbers
                self._directions[name] = _ParameterDerivatives(numbers, 0.0, shape)
        return self._directions[name]

    def _condition_derivatives(self, name: str) -> _ParameterDerivatives:
        """Derivatives of the equations' numbers, and of S_f, by a condition in its key's unit."""
        conditions, numbers, strength = self.request.conditions, np.zeros(_COUNT), 0.0
        turns = conditions.side_force > 0.0
        if name == "edge_angle_deg":
            numbers[_ANGLE] = DEGREE
            numbers[_SIDE_FORCE] = turns * conditions.load / math.cos(conditions.edge_angle) ** 2 * DEGREE
            if conditions.pitch_of_shear != 0.0:  # free: cos ϑ and sin ϑ
                numbers[_PITCH] = -math.sin(conditions.edge_angle) * DEGREE
                numbers[_PITCH_OF_SHEAR] = math.cos(conditions.edge_angle) * DEGREE
        elif name == "load_N":
            numbers[_LOAD], numbers[_SIDE_FORCE] = 1.0, turns * math.tan(conditions.edge_angle)
        elif name == "moment_Nm":
            numbers[_MOMENT] = 1.0
        elif name == "unloading_ratio":
            numbers[_EXCESS] = conditions.hardness
        elif name == "snow.H_V_N_per_mm3":
            numbers[_HARDNESS], numbers[_EXCESS] = N_PER_MM3, conditions.excess / conditions.hardness * N_PER_MM3
        else:
            strength = N_PER_MM2
        return _ParameterDerivatives(numbers, strength)


def ski_derivatives(asked: Sequence[tuple[CarveDerivatives, str]], names: tuple[str, ...]) -> FloatArray:
    """Derivatives of outputs of carves with one ski, on one mesh, by parameters of that ski.

    Shape (outputs, parameters). Outputs together take far fewer operations than each for itself.
    """
    request = asked[0][0].request
    model, elements = request.model, request.elements
    tables, numbers = table_growths(model.ski, names)
    gradients = [point._gradient(output) for point, output in asked]
    by_numbers = np.array([gradient.numbers for gradient in gradients])
    out = by_numbers[:, _OF_SHAPE] @ numbers.T
    if tables[:, 0].any():  # the stations move
        by_tables = np.array([point.by_tables(output) for point, output in asked])
        return np.asarray(out + np.tensordot(by_tables, tables, ((1, 2), (1, 2))))
    columns = np.array([gradient.columns[2:4] for gradient in gradients])
    columns[:, 0, widest_station(model.ski, model.clamp_length, elements)] += by_numbers[:, _WIDEST]
    u = np.array([point.at.solution.u for point, _ in asked])
    stiffness = beam_gradients(model, u, np.array([gradient.adjoint for gradient in gradients]))
    edges = [(gradient.output.edge, gradient.output.edge_by) for gradient in gradients]
    return np.asarray(out + growth_by_tables(model, elements, tables, columns, stiffness, edges))


def _slopes_at_stations(model: ClampedSki, u: FloatArray) -> FloatArray:
    """Part of the deflection at the stations that comes from slopes of nodes (m)."""
    stations = model.stations
    value = np.append(u, 0.0)[stations.dof]  # -1: held
    return np.asarray(np.sum((stations.deflection * value)[:, [1, 4]], axis=1))
