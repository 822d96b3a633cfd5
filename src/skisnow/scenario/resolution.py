"""Resolution of a scenario: which value counts when several are given.

Values come in layers: a built-in scenario or a file, then changes (``--set``, ``changes=``, points of a study).
Defaults come below all layers. Two rules decide:

1. The last layer that gives a quantity counts. A campaign's results, a published snow and a snow map give several
   quantities: H_V and S_f, and the results also k_u/H_V and u_y if the campaign measured them.
2. Within one layer, two keys that give the same quantity contradict each other. Exceptions: a snow map next to a named
   snow, and a number for k_u/H_V or u_y next to a named snow; there the map or the number counts.

A key without effect (`CONDITIONS`) is dropped if a later layer made it so, and otherwise an error.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, TypeAlias

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import ShownFields
from ..parameters import InputValue
from ..ski.ski_file import Sources
from ..snow import SnowProperties
from .keys import PATH_KEYS, SCENARIO_KEYS, validate
from .scenario import Scenario
from .snow_map import SnowMap, read_snow_map

H_V: Final = "snow.H_V_N_per_mm3"
S_F: Final = "snow.S_f_N_per_mm2"
UNLOADING: Final = "snow.unloading_ratio"
DISPLACEMENT: Final = "snow.shear_displacement_mm"
NAMED_SNOWS: Final = ("snow.results", "snow.published")
OVERRIDES_NAMED_SNOW: Final = {
    H_V: ("snow.map_file",),
    S_F: ("snow.map_file",),
    UNLOADING: (UNLOADING, "snow.penetration"),
    DISPLACEMENT: (DISPLACEMENT,),
}
"""Keys by quantity that count next to a named snow in the same layer."""

ALTERNATIVES: Final = {"ski.name": "ski", "ski.file": "ski", "course.name": "course", "course.file": "course"}
"""Quantity of each key that is not a quantity itself."""

CONDITIONS: Final = {name: key.condition for name, key in SCENARIO_KEYS.items() if key.condition is not None}
"""Values of other keys without which a key has no effect."""


Provider: TypeAlias = tuple[int, str]
"""Number of a layer, and its key that gives a quantity."""


class ContradictionError(ParameterError):
    """Two keys of one layer give the same quantity, or a key needs another value of a second key."""

    def __init__(self, keys: tuple[str, str], message: Message) -> None:
        super().__init__(message, code="contradiction")
        self.keys = keys

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.keys, self.message)


@dataclass(frozen=True, slots=True)
class Layer:
    """Validated values by full name, and the folder where relative paths among them start."""

    values: Mapping[str, InputValue]
    folder: Path = field(default_factory=Path)


@dataclass(frozen=True, slots=True, repr=False)
class ScenarioInput(ShownFields):
    """A scenario as given, before resolution.

    title: name of a built-in scenario, or path of the file.
    file: Path of the file, None for a built-in scenario.
    layers: values of the file and of each change.
    identify: contents of the section ``[identify]``.
    base: scenario object to which the layers are changes, if the scenario was not read.
    """

    title: str
    file: Path | None
    layers: tuple[Layer, ...]
    identify: Mapping[str, Any] = field(default_factory=dict)
    base: Scenario | None = None

    def changed(self, changes: Mapping[str, object], *, folder: Path | None = None) -> ScenarioInput:
        """The same scenario with one more layer.

        folder: folder where relative paths among the changes start (default: the current folder).
        """
        return replace(self, layers=(*self.layers, Layer(validate(changes), folder or Path())))

    @property
    def values(self) -> dict[str, InputValue]:
        """Last value of each key, whether it counts or not."""
        return {name: value for layer in self.layers for name, value in layer.values.items()}


@dataclass(frozen=True, slots=True)
class Resolution:
    """Values from which a scenario is built, after later layers have replaced earlier ones.

    values: by full name, in the units of the keys.
    files: paths of the files that the values name, by key.
    snow: the named snow, None if H_V and S_f are numbers.
    snow_map: the snow map, None without one.
    """

    values: Mapping[str, InputValue]
    files: Mapping[str, Path]
    snow: SnowProperties | None
    snow_map: SnowMap | None


def resolve(scenario_input: ScenarioInput, sources: Sources) -> Resolution:
    """Decide which values count, by the two rules of this module."""
    providers: dict[str, Provider] = {}
    latest: dict[str, int] = {}
    snows: dict[Provider, SnowProperties | SnowMap] = {}
    files: dict[str, Path] = {}
    for number, layer in enumerate(scenario_input.layers):
        for name in layer.values:
            latest[name] = number
            if name in PATH_KEYS:
                files[name] = layer.folder / str(layer.values[name])
        values = {
            name: value for name, value in scenario_input.values.items() if latest.get(name, number + 1) <= number
        }
        replaced = "snow.results" not in values or providers.get(H_V, (-1, ""))[0] > latest["snow.results"]
        if "snow.site" in layer.values and replaced:
            raise ContradictionError(
                ("snow.site", H_V),
                Message("{name} goes with {condition}. Change one of them", name="snow.site", condition="snow.results"),
            )
        layer_snows = _read_snows(layer, values, files, sources)
        snows |= {(number, name): snow for name, snow in layer_snows.items()}
        given: dict[str, list[str]] = {}  # keys of the layer by the quantity that they give
        for name, value in {**layer.values, **dict.fromkeys(layer_snows.keys() - layer.values.keys(), "")}.items():
            for quantity in _quantities(name, value, layer_snows, layer):
                given.setdefault(quantity, []).append(name)
        for quantity, names in given.items():
            providers[quantity] = (number, _strongest(quantity, names, layer))
    snow_provider, measured = _named_snow(providers, snows)
    counting = {name for _, name in providers.values() if name not in NAMED_SNOWS} | {snow_provider[1]}
    values = {
        name: value
        for name, value in scenario_input.values.items()
        if name in counting or name not in (*OVERRIDES_NAMED_SNOW, *NAMED_SNOWS, *ALTERNATIVES, "snow.map_file")
    }
    if UNLOADING in counting and values[UNLOADING] != 1.0 and values.get("snow.penetration") == "elastic":
        del values["snow.penetration"]  # the number comes from a later layer, else the two contradict each other
    values = dict(_with_effect(values, latest, providers)) | measured
    map_provider = (latest.get("snow.map_file", -1), "snow.map_file")
    _require_unmapped(map_provider, providers, snows)
    snow = snows.get(snow_provider)
    snow_map = snows[map_provider] if "snow.map_file" in values else None
    assert not isinstance(snow, SnowMap)
    assert not isinstance(snow_map, SnowProperties)
    return Resolution(values, {name: path for name, path in files.items() if name in values}, snow, snow_map)


def _named_snow(
    providers: Mapping[str, Provider], snows: Mapping[Provider, SnowProperties | SnowMap]
) -> tuple[Provider, dict[str, InputValue]]:
    """Key of the named snow that counts, and k_u/H_V and u_y that snows of earlier layers have measured."""
    named = {quantity: providers[quantity] for quantity in OVERRIDES_NAMED_SNOW if quantity in providers}
    named = {quantity: provider for quantity, provider in named.items() if provider[1] in NAMED_SNOWS}
    main = next(iter(named.values()), (-1, ""))
    measured: dict[str, InputValue] = {}
    for quantity, provider in named.items():
        snow = snows[provider]
        if provider != main and isinstance(snow, SnowProperties):
            number = {UNLOADING: snow.unloading_ratio, DISPLACEMENT: snow.shear_displacement}[quantity]
            measured |= {} if number is None else {quantity: SCENARIO_KEYS[quantity].in_unit(number)}
    return main, measured


def _require_unmapped(
    map_provider: Provider, providers: Mapping[str, Provider], snows: Mapping[Provider, SnowProperties | SnowMap]
) -> None:
    """Reject a number in a layer above the snow map that gives the same quantity over the place."""
    number, name = map_provider
    for quantity in _quantities(name, "", {name: snows[map_provider]}, Layer({})) if map_provider in snows else ():
        if providers[quantity][1] == quantity and providers[quantity][0] > number:
            raise _contradiction(name, quantity, quantity)


def _read_snows(
    layer: Layer, values: Mapping[str, InputValue], files: Mapping[str, Path], sources: Sources
) -> dict[str, SnowProperties | SnowMap]:
    """Named snow and snow map of a layer, by key; a new site of the same results is a new snow."""
    snows: dict[str, SnowProperties | SnowMap] = {}
    if "snow.results" in layer.values or ("snow.site" in layer.values and "snow.results" in values):
        words = {"results": str(files["snow.results"]), "site": values.get("snow.site")}
        snows["snow.results"] = sources.named_snow(words)
    if "snow.published" in layer.values:
        snows["snow.published"] = sources.named_snow({"published": layer.values["snow.published"]})
    if "snow.map_file" in layer.values:
        snows["snow.map_file"] = read_snow_map(files["snow.map_file"])
    return snows


def _quantities(
    name: str, value: InputValue, snows: Mapping[str, SnowProperties | SnowMap], layer: Layer
) -> Iterator[str]:
    """Quantities that one key gives."""
    snow = snows.get(name)
    if isinstance(snow, SnowProperties):
        yield H_V
        if snow.failure_shear_stress is not None or S_F not in layer.values:
            yield S_F
        if snow.unloading_ratio is not None:
            yield UNLOADING
        if snow.shear_displacement is not None:
            yield DISPLACEMENT
    elif isinstance(snow, SnowMap):
        yield from (key for key, mean in ((H_V, snow.mean_hardness), (S_F, snow.mean_stress)) if mean is not None)
        if snow.friction_share is not None:
            yield "snow.map_file"  # of no other key
    else:
        yield ALTERNATIVES.get(name, name)
        if name == "snow.penetration" and value == "elastic" and layer.values.get(UNLOADING) != 1.0:
            yield UNLOADING


def _strongest(quantity: str, names: list[str], layer: Layer) -> str:
    """Key whose value counts, if several keys of one layer give a quantity; ContradictionError if none has priority."""
    others = [name for name in names if name not in NAMED_SNOWS]
    beside_one_snow = len(names) == 2 and len(others) == 1  # two named snows contradict each other also below a map
    if len(names) == 1 or (beside_one_snow and others[0] in OVERRIDES_NAMED_SNOW.get(quantity, ())):
        return (others or names)[0]
    first, second = sorted(names, key=lambda name: name not in NAMED_SNOWS)[:2] if len(names) > 2 else names
    if quantity == UNLOADING:
        ratio = layer.values[UNLOADING]
        raise ContradictionError(
            (first, second),
            Message(
                '{name} is {ratio:g}, but snow.penetration = "elastic" means 1. Remove one', name=UNLOADING, ratio=ratio
            ),
        )
    raise _contradiction(first, second, quantity)


def _contradiction(first: str, second: str, quantity: str) -> ContradictionError:
    """Error for two keys of one layer that both give a quantity."""
    what = SCENARIO_KEYS[quantity].label or quantity if quantity in SCENARIO_KEYS else quantity
    return ContradictionError(
        (first, second),
        Message(
            "{first} and {second} both give {quantity}. Keep one of them", first=first, second=second, quantity=what
        ),
    )


def _with_effect(
    values: Mapping[str, InputValue], latest: Mapping[str, int], providers: Mapping[str, Provider]
) -> Iterator[tuple[str, InputValue]]:
    """Values without the keys that a later layer left without effect."""
    for name, value in values.items():
        condition = CONDITIONS.get(name)
        if condition is None:
            if name != "snow.site" or "snow.results" in values:
                yield name, value
            continue
        main = condition.key
        if condition.holds(values.get(main, SCENARIO_KEYS[main].default)):
            yield name, value
        elif max(latest.get(main, -1), providers.get(main, (-1, ""))[0]) <= latest[name]:
            raise ContradictionError(
                (name, main),
                Message("{name} goes with {condition}. Change one of them", name=name, condition=condition.in_words),
            )
