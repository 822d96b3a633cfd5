"""Mutations of NetCDF-3 files: values, shapes, variables, attributes and the JSON texts among them."""

import io
import warnings
from random import Random
from typing import Any, Final

import numpy as np
from scipy.io import netcdf_file

from . import values
from .binaries import BINARY, bits
from .texts import Mutation
from .trees import json_tree


def contents(rng: Random, data: bytes) -> bytes:
    """One to three changes of the file's content; if it is not NetCDF, change its bytes."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return _changed(rng, data)
    except Exception:  # whatever an earlier mutation has made of it
        return bits(rng, data)


def _changed(rng: Random, data: bytes) -> bytes:
    source: Any = netcdf_file(io.BytesIO(data), "r", mmap=False)
    sizes = dict(source.dimensions)
    arrays = {
        name: (np.array(each[:]), each.dimensions, dict(each._attributes)) for name, each in source.variables.items()
    }
    attributes = dict(source._attributes)
    for _ in range(rng.randrange(1, 4)):
        rng.choice((_number, _number, _number, _number, _variable, _attribute, _attribute, _size))(
            rng, sizes, arrays, attributes
        )
    return _written(sizes, arrays, attributes)


def _number(rng: Random, _sizes: Any, arrays: Any, _attributes: Any) -> None:
    name = rng.choice(sorted(arrays))
    array = arrays[name][0]
    if array.dtype.kind != "f" or not array.size:
        return
    value = rng.choice(values.FLOATS)
    if rng.random() < 0.4:
        array.flat[rng.randrange(array.size)] = value
    elif rng.random() < 0.5:
        array[...] = value
    else:
        array[...] = array * value


def _variable(rng: Random, _sizes: Any, arrays: Any, _attributes: Any) -> None:
    name, other = rng.choice(sorted(arrays)), rng.choice(sorted(arrays))
    how = rng.randrange(4)
    if how == 0:
        del arrays[name]
    elif how == 1:
        arrays[name] = arrays[other]
    elif how == 2 and arrays[name][0].dtype.kind == "f":
        arrays[name] = (arrays[name][0].astype(rng.choice(("f4", "i4", "i2", "i1"))), *arrays[name][1:])
    else:
        array, dimensions, kept = arrays[name]
        arrays[name] = (array.T, dimensions[::-1], kept)


def _attribute(rng: Random, _sizes: Any, arrays: Any, attributes: Any) -> None:
    kept = attributes if rng.random() < 0.7 else arrays[rng.choice(sorted(arrays))][2]
    if not kept:
        return
    name = rng.choice(("scenario", "outcome", "boots", *sorted(kept)))
    if name not in kept or rng.random() < 0.1:
        kept.pop(name, None)
    elif isinstance(kept[name], bytes):
        is_json = kept[name].startswith(b"{") and rng.random() < 0.8
        kept[name] = json_tree(rng, kept[name]) if is_json else values.word(rng).encode("utf-8", "replace")
    else:
        kept[name] = np.float64(rng.choice(values.FLOATS))


def _size(rng: Random, sizes: Any, arrays: Any, _attributes: Any) -> None:
    """A dimension has another length, and all arrays along it."""
    name = rng.choice(sorted(each for each in sizes if sizes[each]))
    new = rng.choice((0, 1, 2, max(1, sizes[name] - 1)))
    if new >= sizes[name]:
        return
    for variable, (array, dimensions, kept) in list(arrays.items()):
        if name in dimensions:
            arrays[variable] = (np.take(array, range(new), axis=dimensions.index(name)), dimensions, kept)
    sizes[name] = new


def _written(sizes: Any, arrays: Any, attributes: Any) -> bytes:
    memory = io.BytesIO()
    file: Any = netcdf_file(memory, "w", version=2)
    for name, value in attributes.items():
        setattr(file, name, value)
    for name, size in sizes.items():
        file.createDimension(name, size)
    for name, (array, dimensions, kept) in arrays.items():
        kind = "c" if array.dtype.kind == "S" else array.dtype.newbyteorder(">")
        written = file.createVariable(name, kind, dimensions)
        written[:] = array
        for key, value in kept.items():
            setattr(written, key, value)
    file.flush()
    content = memory.getvalue()
    file.close()
    return content


NETCDF: Final[tuple[Mutation, ...]] = (contents,) * 7 + BINARY[-3:]
