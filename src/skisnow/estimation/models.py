"""The paper's nine candidate models of the penetration force (Eqn 6) and the choice between them.

F = H (a(ϑ) A + b(ϑ) V), H one of three hardness definitions, a and b absent, constant or linear in ϑ, fitted to all
readings at once with a ≥ 0 and b ≥ 0 over the whole range of ϑ in the data. A linear coefficient is carried by its
values at the two ends of that range: non-negative at both ends is non-negative between.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final, Literal, TypeAlias

import numpy as np

from .._support.arrays import BoolArray, FloatArray
from .._support.messages import Message
from .._support.units import ShownFields
from ..statistics.bounded import Condensed, condensed
from .hardness import DEFINITIONS
from .readings import Readings

Term: TypeAlias = Literal["none", "one", "constant", "linear"]


FORMS: Final = {"constant": Message("constant"), "linear": Message("linear")}


@dataclass(frozen=True, slots=True)
class Model:
    """One row of the table: which hardness, which form of a(ϑ) and of b(ϑ)."""

    hardness: str
    a: Term
    b: Term

    @property
    def id(self) -> str:
        """Name of the row in results and tables."""
        return f"{self.hardness}:a={self.a},b={self.b}"

    @property
    def words(self) -> Message:
        """The row in a few words, for tables and sentences.

        >>> Model("H_V", "none", "one").words, Model("H_A", "linear", "linear").words
        ('H_V; b = 1', 'H_A; a, b linear')
        """
        if self.b == "one":
            return Message("{hardness}; b = 1", hardness=self.hardness)
        b = FORMS[self.b]
        if self.a == "none":
            return Message("{hardness}; b {b}", hardness=self.hardness, b=b)
        if self.a == self.b:
            return Message("{hardness}; a, b {b}", hardness=self.hardness, b=b)
        return Message("{hardness}; a {a}, b {b}", hardness=self.hardness, a=FORMS[self.a], b=b)

    @property
    def n_parameters(self) -> int:
        """Nominal number of fitted parameters."""
        return _N_PARAMETERS[self.a] + _N_PARAMETERS[self.b]

    @property
    def n_terms(self) -> int:
        """Number of terms that the law has, fitted or not."""
        return (self.a != "none") + (self.b != "none")

    def contains(self, other: Model) -> bool:
        """True if the other row is a special case of this one."""
        return (
            self != other
            and self.hardness == other.hardness
            and _N_PARAMETERS[self.a] >= _N_PARAMETERS[other.a]
            and _N_PARAMETERS[self.b] >= _N_PARAMETERS[other.b]
        )


EXACT: Final = 1e-11
"""Residuals below this share of the loads are rounding of some thousand operations."""
_N_PARAMETERS: Final = {"none": 0, "one": 0, "constant": 1, "linear": 2}

MODELS: Final = (
    Model("H_e", "linear", "linear"),
    Model("H_A", "linear", "linear"),
    Model("H_V", "linear", "linear"),
    Model("H_e", "constant", "constant"),
    Model("H_A", "constant", "constant"),
    Model("H_V", "constant", "constant"),
    Model("H_V", "none", "linear"),
    Model("H_V", "none", "constant"),
    Model("H_V", "none", "one"),
)
"""The paper's nine candidate models, in its order."""

NESTED_PAIRS: Final = tuple((full, reduced) for full in MODELS for reduced in MODELS if full.contains(reduced))


@dataclass(frozen=True, repr=False)
class ModelFit(ShownFields):
    """A fitted row, in SI (a and b such that F in N from A in m², V in m³, H in SI, ϑ in rad).

    a0, a1, b0, b1: coefficients; a1, b1 are NaN where the edge angle does not vary.
    n, n_series, n_parameters: readings, series, nominal fitted parameters (where the edge angle does not vary: the rank
        of the design).
    rmse, rmse_dof, rmse_free: over n; over n - n_parameters; without each series' defining reading, over n - n_series
        (N). NaN where undefined.
    at_bound: which coefficients sit on their bound, at which end of the data's angles.
    sse: sum of squared residuals (N²).
    """

    model: Model
    a0: float
    a1: float
    b0: float
    b1: float
    n: int
    n_series: int
    n_parameters: int
    rmse: float
    rmse_dof: float
    rmse_free: float
    at_bound: tuple[str, ...]
    sse: float


@dataclass(frozen=True)
class EndBasis:
    """The four regressors H A (1-t), H A t, H V (1-t), H V t, with t = (ϑ - ϑ_low)/(ϑ_high - ϑ_low).

    Their coefficients are a(ϑ_low), a(ϑ_high), b(ϑ_low), b(ϑ_high). ``flat``: ϑ does not vary, and t = 0.
    """

    columns: FloatArray
    low: float
    high: float

    @property
    def flat(self) -> bool:
        """True if all series have the same edge angle."""
        return self.high <= self.low

    def projection(self, model: Model) -> FloatArray:
        """Matrix (4, p) from the fitted parameters of a model to the four end values."""
        return _projection(model.a, model.b, self.flat)

    def offset(self, model: Model) -> FloatArray:
        """End values (4,) that a model fixes: b = 1 if nothing is fitted, otherwise 0."""
        return np.array([0.0, 0.0, 1.0, 1.0]) if model.b == "one" else np.zeros(4)

    def coefficients(self, ends: FloatArray) -> FloatArray:
        """(..., 4) a0, a1, b0, b1 from the end values (..., 4); slopes are NaN where ϑ does not vary."""
        span = np.nan if self.flat else self.high - self.low
        a1, b1 = (ends[..., 1] - ends[..., 0]) / span, (ends[..., 3] - ends[..., 2]) / span
        a0, b0 = (
            (ends[..., 0], ends[..., 2]) if self.flat else (ends[..., 0] - a1 * self.low, ends[..., 2] - b1 * self.low)
        )
        return np.stack((a0, a1, b0, b1), axis=-1)


@cache
def _projection(a: Term, b: Term, flat: bool) -> FloatArray:
    """Matrix (4, p) from the fitted parameters of a model to its four end values; `flat`: all series have one angle."""
    block = {"none": np.zeros((2, 0)), "one": np.zeros((2, 0)), "constant": np.ones((2, 1)), "linear": np.eye(2)}
    if flat:
        block["linear"] = block["constant"]
    of_a, of_b = block[a], block[b]
    made = np.zeros((4, of_a.shape[1] + of_b.shape[1]))
    made[:2, : of_a.shape[1]], made[2:, of_a.shape[1] :] = of_a, of_b
    made.flags.writeable = False  # shared by all who ask
    return made


def end_basis(readings: Readings, hardness: FloatArray) -> EndBasis:
    """Build the regressors from the hardness of each series (SI)."""
    low, high = float(readings.edge_angle.min()), float(readings.edge_angle.max())
    columns = weighted_columns(readings, hardness, readings.contact_area, readings.displaced_volume)
    return EndBasis(columns, low, high)


def weighted_columns(readings: Readings, hardness: FloatArray, of_a: FloatArray, of_b: FloatArray) -> FloatArray:
    """Columns (n, 4) H a (1-t), H a t, H b (1-t), H b t; a and b: area and volume, or their derivatives by depth."""
    low, high = readings.edge_angle.min(), readings.edge_angle.max()
    t = (readings.angle_of_reading - low) / (high - low) if high > low else np.zeros(readings.n)
    H = hardness[readings.series]
    Ha, Hb = H * of_a, H * of_b
    # each column contiguous, as the sums over it want it
    return np.stack((Ha * (1.0 - t), Ha * t, Hb * (1.0 - t), Hb * t)).T


def fit_model(readings: Readings, basis: EndBasis, model: Model, of_load: Condensed) -> ModelFit:
    """Least-squares fit of one row to all readings (Eqn 6); `of_load` contains the basis and the loads."""
    projection, ends = basis.projection(model), basis.offset(model)
    bound, n_parameters = np.zeros(4, dtype=bool), 0
    if model.n_parameters:
        solution = of_load.solved(projection, ends)
        bound = (projection @ (solution.coefficients == 0.0)) > 0
        ends = ends + projection @ solution.coefficients
        n_parameters = solution.rank if basis.flat else model.n_parameters
    n, m = readings.n, readings.n_series
    squares = (basis.columns @ ends - readings.load) ** 2
    if float(squares.sum()) <= (EXACT * float(np.linalg.norm(readings.load))) ** 2:
        squares = np.zeros(n)  # a fit to rounding is exact: rounding must not choose between models
    sse = float(squares.sum())
    free = sse - float(squares[readings.largest].sum())
    a0, a1, b0, b1 = (float(c) for c in basis.coefficients(ends))
    return ModelFit(
        model=model,
        a0=a0,
        a1=a1 if model.a == "linear" else 0.0,
        b0=b0,
        b1=b1 if model.b == "linear" else 0.0,
        n=n,
        n_series=m,
        n_parameters=n_parameters,
        rmse=_root_mean(sse, n),
        rmse_dof=_root_mean(sse, n - n_parameters),
        rmse_free=_root_mean(max(free, 0.0), n - m),
        at_bound=_coefficients_at_bound(model, basis, bound),
        sse=sse,
    )


def _root_mean(sse: float, count: int) -> float:
    """√(sse/count); NaN if the count is not positive."""
    return float(np.sqrt(sse / count)) if count > 0 else float("nan")


def _coefficients_at_bound(model: Model, basis: EndBasis, bound: BoolArray) -> tuple[str, ...]:
    """Names of the coefficients of a fit at their bound; for a linear term with the edge angle of that end."""
    names: list[str] = []
    for term, name, start in ((model.a, "a", 0), (model.b, "b", 2)):
        if term == "constant" or (term == "linear" and basis.flat):
            names += [name] if bound[start] else []
        elif term == "linear":
            ends = (basis.low, basis.high)
            names += [
                f"{name}@{round(float(np.degrees(end)), 11):.12g}deg" for i, end in enumerate(ends) if bound[start + i]
            ]
    return tuple(names)


def fit_models(readings: Readings, hardnesses: dict[str, FloatArray]) -> tuple[ModelFit, ...]:
    """Fit the nine candidate models; ``hardnesses`` gives H of each series (SI) by definition."""
    bases = {symbol: end_basis(readings, hardnesses[symbol]) for symbol in DEFINITIONS}
    of_load = {symbol: condensed(basis.columns, readings.load) for symbol, basis in bases.items()}
    return tuple(fit_model(readings, bases[model.hardness], model, of_load[model.hardness]) for model in MODELS)


TOLERANCE: Final = 0.05
"""Relative rmse above the best at which a simpler row is chosen."""
FEWEST_SERIES: Final = 4
"""Fewer series do not tell one law from another (modelling assumption)."""
FEWEST_ANGLES: Final = 2
"""At one edge angle a and b are one number each, and rows repeat each other."""


def reason_without_choice(readings: Readings) -> str:
    """Reason why these readings cannot select a law, as a sentence; empty if they can."""
    angles = len(np.unique(np.round(readings.edge_angle, 9)))
    if readings.n_series >= FEWEST_SERIES and angles >= FEWEST_ANGLES:
        return ""
    return Message(
        "No law of the penetration force is selected: the choice needs {fewest_series} series at {fewest_angles} "
        "edge angles; {n_series} at {angles} are used.",
        fewest_series=FEWEST_SERIES,
        fewest_angles=FEWEST_ANGLES,
        n_series=readings.n_series,
        angles=angles,
    )


def select_model(fits: tuple[ModelFit, ...]) -> ModelFit:
    """The simplest row with an rmse within 5 % of the best: fewest parameters, smaller rmse, fewer terms.

    Where rows repeat each other, because the edge angle does not vary, the nominally simpler one is chosen.
    """
    best = min(fit.rmse for fit in fits)
    near = [fit for fit in fits if fit.rmse <= best * (1.0 + TOLERANCE)]
    return min(near, key=lambda fit: (fit.n_parameters, fit.rmse, fit.model.n_terms, fit.model.n_parameters))
