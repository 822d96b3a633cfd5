"""The models of the 27 nonlinear sets of the NIST Statistical Reference Datasets, as their files print them."""

from collections.abc import Callable
from typing import Final

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Model = Callable[..., FloatArray]


def bennett5(x: FloatArray, b1: float, b2: float, b3: float) -> FloatArray:
    return np.asarray(b1 * (b2 + x) ** (-1 / b3))


def boxbod(x: FloatArray, b1: float, b2: float) -> FloatArray:
    return np.asarray(b1 * (1 - np.exp(-b2 * x)))


def chwirut(x: FloatArray, b1: float, b2: float, b3: float) -> FloatArray:
    return np.asarray(np.exp(-b1 * x) / (b2 + b3 * x))


def danwood(x: FloatArray, b1: float, b2: float) -> FloatArray:
    return np.asarray(b1 * x**b2)


def eckerle4(x: FloatArray, b1: float, b2: float, b3: float) -> FloatArray:
    return np.asarray((b1 / b2) * np.exp(-0.5 * ((x - b3) / b2) ** 2))


def enso(x: FloatArray, *b: float) -> FloatArray:
    year, b4, b7 = 2 * np.pi * x / 12, 2 * np.pi * x / b[3], 2 * np.pi * x / b[6]
    return np.asarray(
        b[0]
        + (b[1] * np.cos(year) + b[2] * np.sin(year))
        + (b[4] * np.cos(b4) + b[5] * np.sin(b4))
        + (b[7] * np.cos(b7) + b[8] * np.sin(b7))
    )


def gauss(x: FloatArray, *b: float) -> FloatArray:
    first, second = np.exp(-((x - b[3]) ** 2) / b[4] ** 2), np.exp(-((x - b[6]) ** 2) / b[7] ** 2)
    return np.asarray(b[0] * np.exp(-b[1] * x) + b[2] * first + b[5] * second)


def cubic_over_cubic(x: FloatArray, *b: float) -> FloatArray:
    above = b[0] + b[1] * x + b[2] * x**2 + b[3] * x**3
    return np.asarray(above / (1 + b[4] * x + b[5] * x**2 + b[6] * x**3))


def kirby2(x: FloatArray, *b: float) -> FloatArray:
    return np.asarray((b[0] + b[1] * x + b[2] * x**2) / (1 + b[3] * x + b[4] * x**2))


def lanczos(x: FloatArray, *b: float) -> FloatArray:
    return np.asarray(b[0] * np.exp(-b[1] * x) + b[2] * np.exp(-b[3] * x) + b[4] * np.exp(-b[5] * x))


def mgh09(x: FloatArray, *b: float) -> FloatArray:
    return np.asarray(b[0] * (x**2 + x * b[1]) / (x**2 + x * b[2] + b[3]))


def mgh10(x: FloatArray, b1: float, b2: float, b3: float) -> FloatArray:
    return np.asarray(b1 * np.exp(b2 / (x + b3)))


def mgh17(x: FloatArray, *b: float) -> FloatArray:
    return np.asarray(b[0] + b[1] * np.exp(-x * b[3]) + b[2] * np.exp(-x * b[4]))


def misra1b(x: FloatArray, b1: float, b2: float) -> FloatArray:
    return np.asarray(b1 * (1 - (1 + b2 * x / 2) ** (-2)))


def misra1c(x: FloatArray, b1: float, b2: float) -> FloatArray:
    return np.asarray(b1 * (1 - (1 + 2 * b2 * x) ** (-0.5)))


def misra1d(x: FloatArray, b1: float, b2: float) -> FloatArray:
    return np.asarray(b1 * b2 * x * ((1 + b2 * x) ** (-1)))


def nelson(x: FloatArray, b1: float, b2: float, b3: float) -> FloatArray:
    """Of log y; x holds two columns."""
    return np.asarray(b1 - b2 * x[:, 0] * np.exp(-b3 * x[:, 1]))


def rat42(x: FloatArray, b1: float, b2: float, b3: float) -> FloatArray:
    return np.asarray(b1 / (1 + np.exp(b2 - b3 * x)))


def rat43(x: FloatArray, b1: float, b2: float, b3: float, b4: float) -> FloatArray:
    return np.asarray(b1 / ((1 + np.exp(b2 - b3 * x)) ** (1 / b4)))


def roszman1(x: FloatArray, b1: float, b2: float, b3: float, b4: float) -> FloatArray:
    return np.asarray(b1 - b2 * x - np.arctan(b3 / (x - b4)) / np.pi)


MODELS: Final[dict[str, Model]] = {
    "Bennett5": bennett5,
    "BoxBOD": boxbod,
    "Chwirut1": chwirut,
    "Chwirut2": chwirut,
    "DanWood": danwood,
    "ENSO": enso,
    "Eckerle4": eckerle4,
    "Gauss1": gauss,
    "Gauss2": gauss,
    "Gauss3": gauss,
    "Hahn1": cubic_over_cubic,
    "Kirby2": kirby2,
    "Lanczos1": lanczos,
    "Lanczos2": lanczos,
    "Lanczos3": lanczos,
    "MGH09": mgh09,
    "MGH10": mgh10,
    "MGH17": mgh17,
    "Misra1a": boxbod,
    "Misra1b": misra1b,
    "Misra1c": misra1c,
    "Misra1d": misra1d,
    "Nelson": nelson,
    "Rat42": rat42,
    "Rat43": rat43,
    "Roszman1": roszman1,
    "Thurber": cubic_over_cubic,
}
