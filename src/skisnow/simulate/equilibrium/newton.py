"""Newton's method with damping by the natural monotonicity test, on the bordered banded system.

Source of the test: P. Deuflhard (2004), *Newton methods for nonlinear problems*, section 3.3: a step is accepted when
the simplified Newton correction that follows it is smaller than the step's own. It does not depend on how the
equations are scaled.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from ...ski.beam.banded import factor, solve
from .assembly import BORDER, Conditions, Sections, System, assemble

FloatArray: TypeAlias = npt.NDArray[np.float64]

STRESS_AS_DEPTH = 1e-3
"""A change of the shear stress by its whole counts like a change of depth by this (m)."""
SMALLEST_DAMPING = 1e-4
STALL_TOLERANCE = 1e-6
"""Correction at which rounding may end the iteration, as a share of the greatest depth."""
FORCE_TOLERANCE = 1e-8
"""Force left unbalanced, as a share of the load."""


class Factored(NamedTuple):
    """A linearised system ready to be solved for several right sides."""

    matrix: FloatArray  # (n, 11) LU factors
    influence: FloatArray  # (n, p) the beam's answer to each border unknown
    rows: FloatArray  # (p, n)
    schur: FloatArray  # (p, p) LU factors
    order: npt.NDArray[np.int64]  # (p,) rows exchanged


@compiled(error_model="numpy")
def _factor_dense(matrix: FloatArray) -> npt.NDArray[np.int64]:
    """LU factors with row pivots in place; not finite where singular."""
    n = len(matrix)
    order = np.empty(n, np.int64)
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        order[k] = best
        if best != k:
            for j in range(n):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        pivot = 1.0 / matrix[k, k]
        for i in range(k + 1, n):
            ratio = matrix[i, k] * pivot
            matrix[i, k] = ratio
            if ratio != 0.0:
                matrix[i, k + 1 :] -= ratio * matrix[k, k + 1 :]
    return order


@compiled(error_model="numpy")
def _solve_dense(factors: FloatArray, order: npt.NDArray[np.int64], right: FloatArray) -> None:
    """Solve in place with the factors of `_factor_dense`."""
    n = len(right)
    for k in range(n):
        right[k], right[order[k]] = right[order[k]], right[k]
    for i in range(n):
        for j in range(i):
            right[i] -= factors[i, j] * right[j]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            right[i] -= factors[i, j] * right[j]
        right[i] /= factors[i, i]


@compiled(error_model="numpy")
def _factored(system: System) -> Factored:
    """Factor the bordered system: the beam first, then what is left of the border."""
    p, n = system.used[0], len(system.residual)
    matrix = system.matrix.copy()
    factor(matrix)
    influence = np.empty((n, p))
    for k in range(p):
        for j in range(n):
            influence[j, k] = system.columns[k, j]
    solve(matrix, influence, p)
    rows = system.rows[:p].copy()
    schur = system.corner[:p, :p].copy()
    # plain loops: the threads of a linear algebra library would stand in each other's way where many skis run at once
    for a in range(p):
        for j in range(n):
            if rows[a, j] != 0.0:
                schur[a] -= rows[a, j] * influence[j]
    order = _factor_dense(schur)
    return Factored(matrix, influence, rows, schur, order)


@compiled(error_model="numpy")
def _correction(at: Factored, system: System, step: FloatArray, border_step: FloatArray) -> bool:
    """Newton correction for the residuals of `system`; False where the equations are singular."""
    n, p = len(step), len(at.schur)
    work = np.empty((n, 1))
    work[:, 0] = -system.residual
    solve(at.matrix, work, 1)
    y = np.zeros(p)
    y[:BORDER] = -system.border_residual[:BORDER]
    for a in range(p):
        for j in range(n):
            y[a] -= at.rows[a, j] * work[j, 0]
    _solve_dense(at.schur, at.order, y)
    border_step[:] = y[:BORDER]
    for j in range(n):
        step[j] = work[j, 0]
        for a in range(p):
            step[j] -= at.influence[j, a] * y[a]
    return bool(np.all(np.isfinite(y)) and np.all(np.isfinite(step)))


@compiled(error_model="numpy")
def _length_of(
    sections: Sections, conditions: Conditions, step: FloatArray, border_step: FloatArray, stress: float
) -> float:
    """Root mean square change of the edge depth along the ski (m); of the shear stress too, as a depth."""
    cosine = np.cos(conditions.edge_angle)
    total = 0.0
    n = len(sections.station)
    for i in range(n):
        change = border_step[0] + border_step[1] * sections.station[i]
        for k in range(6):
            j = sections.dof[i, k]
            if j >= 0:
                change -= cosine * sections.deflection[i, k] * step[j]
                change += 0.5 * sections.width[i] * cosine * sections.twist[i, k] * step[j] * conditions.twists
        total += change * change
    by_stress = STRESS_AS_DEPTH * border_step[2] / max(abs(stress), 1.0)
    return np.sqrt(total / n + by_stress * by_stress)


@compiled(error_model="numpy")
def newton(
    sections: Sections, conditions: Conditions, stiffness: FloatArray, u: FloatArray, border: FloatArray,
    system: System, spare: System, tolerance: float, most: int,
) -> tuple[bool, int]:  # fmt: skip
    """Solve for the equilibrium in place of (u, border); returns whether it converged and the iterations used.

    `system` holds the equations at the returned state when it converged; `tolerance` (m) is the size of the last
    correction to the edge depth.
    """
    result = system
    step, trial_step = np.zeros(len(u)), np.zeros(len(u))
    border_step, trial_border_step = np.zeros(BORDER), np.zeros(BORDER)
    assemble(sections, conditions, stiffness, u, border, system)
    damping = 1.0
    for iteration in range(most):
        here = _factored(system)
        if not _correction(here, system, step, border_step):
            return False, iteration
        length = _length_of(sections, conditions, step, border_step, border[2])
        damping = min(1.0, 2.0 * damping)
        following = np.inf
        while damping > SMALLEST_DAMPING:
            new_u, new_border = u + damping * step, border + damping * border_step
            assemble(sections, conditions, stiffness, new_u, new_border, spare)
            if _correction(here, spare, trial_step, trial_border_step):
                following = _length_of(sections, conditions, trial_step, trial_border_step, border[2])
            at_rounding = max(length, following) < 100.0 * tolerance
            if following <= (1.0 - 0.25 * damping) * length or at_rounding:
                break
            damping *= 0.5
        if damping <= SMALLEST_DAMPING:
            return False, iteration
        u[:], border[:] = new_u, new_border
        system, spare = spare, system
        balanced = abs(system.border_residual[0]) <= FORCE_TOLERANCE * conditions.load
        # a fine mesh has its rounding floor above the tolerance: there the corrections no longer fall
        floor = STALL_TOLERANCE * np.max(system.depth)
        stalled = following > 0.5 * length and max(length, following) < floor
        if damping == 1.0 and ((following < tolerance and balanced) or stalled):
            assemble(sections, conditions, stiffness, u, border, result)
            return True, iteration + 1
    return False, most
