"""GMRES (Saad and Schultz 1986, SIAM J. Sci. Stat. Comput. 7): a linear system solved by its matrix's products alone.

The caller fills in the products, one after the other; what is left is minimised over all of them.
"""

from __future__ import annotations

from typing import Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN

FloatArray: TypeAlias = npt.NDArray[np.float64]

MOST_PRODUCTS: Final = 20


class Products(NamedTuple):
    """Directions and what the matrix makes of them."""

    direction: FloatArray  # (MOST_PRODUCTS + 1, n) orthogonal, of length 1
    upper: FloatArray  # (MOST_PRODUCTS, MOST_PRODUCTS + 1) products in these directions, turned to an upper triangle
    turn: FloatArray  # (MOST_PRODUCTS, 2) cosines and sines by which
    left: FloatArray  # (MOST_PRODUCTS + 1,) of the right side


@compiled(**PLAIN)
def length(vector: FloatArray) -> float:
    """Root of the sum of squares."""
    total = 0.0
    for i in range(len(vector)):
        total += vector[i] * vector[i]
    return np.sqrt(total)


@compiled(**PLAIN)
def begin(products: Products, right: FloatArray) -> None:
    """Begin with a right side other than zero; the first direction is its own."""
    size = length(right)
    products.left[:] = 0.0
    products.left[0] = size
    for i in range(len(right)):
        products.direction[0, i] = right[i] / size


@compiled(**PLAIN)
def take(products: Products, number: int, product: FloatArray) -> float:
    """Take the matrix's product with direction `number`, and return how much of the right side is left, 0 to 1."""
    upper, turn, left = products.upper[number], products.turn, products.left
    size, before = len(product), length(product)
    for j in range(number + 1):
        upper[j] = 0.0
        for i in range(size):
            upper[j] += products.direction[j, i] * product[i]
        for i in range(size):
            product[i] -= upper[j] * products.direction[j, i]
    beyond = length(product)
    for j in range(number):
        one, other = upper[j], upper[j + 1] if j + 1 <= number else 0.0
        upper[j], upper[j + 1] = turn[j, 0] * one + turn[j, 1] * other, turn[j, 0] * other - turn[j, 1] * one
    diagonal = np.sqrt(upper[number] * upper[number] + beyond * beyond)
    turn[number, 0], turn[number, 1] = upper[number] / diagonal, beyond / diagonal
    upper[number] = diagonal
    left[number + 1], left[number] = -turn[number, 1] * left[number], turn[number, 0] * left[number]
    # a product that lies in the directions known ends the search: what follows would be rounding
    within = beyond <= 1e-12 * before
    for i in range(size):
        products.direction[number + 1, i] = 0.0 if within else product[i] / beyond
    whole = 0.0
    for j in range(number + 2):
        whole += left[j] * left[j]
    return 0.0 if within else abs(left[number + 1]) / np.sqrt(whole)


@compiled(**PLAIN)
def solution(products: Products, count: int, out: FloatArray) -> None:
    """Fill `out` with the combination of `count` directions that leaves least of the right side."""
    left, upper = products.left, products.upper
    for j in range(count - 1, -1, -1):
        for k in range(j + 1, count):
            left[j] -= upper[k, j] * left[k]
        left[j] /= upper[j, j]
    out[:] = 0.0
    for j in range(count):
        for i in range(len(out)):
            out[i] += left[j] * products.direction[j, i]
