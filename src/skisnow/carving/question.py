"""One question about a ski in snow in the words and units of users: its keys, checked, and warnings of other units."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Annotated, Any, Final, Literal

from .._support.errors import ParameterError
from .._support.messages import Message, template
from .._support.units import DEGREE, N_PER_MM2, N_PER_MM3, in_degrees_if_radians
from ..parameters import Allowed, Declared, Label, Quantity, own_quantities, suggest_and_list
from ..ski import Ski
from ..ski.beam import CLAMP_LENGTH, MOST_ELEMENTS
from ..ski.editing import SIDECUT, SkiEdit, edit_stations, edited_ski
from ..snow import SnowProperties
from ..snow.properties import GREATEST_LIKELY_HARDNESS
from .equilibrium import ELEMENTS, GREATEST_EDGE_ANGLE


def carve_question(values: Mapping[str, object]) -> CarveQuestion:
    """Check the inputs of one question and fill in the defaults.

    values: Question from values by the names of `CARVE_KEYS`, in the units in the names.
    Raises ParameterError: a key is unknown (the nearest is named), missing or outside its range, or the snow is not
        given in exactly one way.

    Examples
    --------
    >>> asked = {"ski": "slalom", "edge_angle_deg": 45, "load_N": 800, "published": "race-piste", "unloading_ratio": 10}
    >>> carve_question(asked).moment_Nm
    0.0
    """
    require_known(values)
    require_complete(values)
    inputs: dict[str, Any] = {name: CARVE_KEYS[name].in_range(value) for name, value in values.items()}
    return CarveQuestion(**inputs)


def require_known(names: Iterable[str]) -> None:
    """Reject an unknown name, and suggest the nearest one."""
    for name in names:
        if name not in CARVE_KEYS:
            raise ParameterError("unknown input of a carved turn: {name}. {allowed}").tag(
                "unknown_name", name=name, allowed=suggest_and_list(name, CARVE_KEYS)
            )


def require_complete(values: Mapping[str, object]) -> None:
    """Refuse inputs that lack one without a default, or name the snow in no way or in two; a site needs results.

    Call it with all names of a study before its first point.
    """
    rests = values.get("at_rest") is True
    for name in ("ski", "edge_angle_deg", "load_N", *(() if rests else ("unloading_ratio",))):
        if name not in values:
            raise ParameterError("{name} is missing: {meaning}. It has no default").tag(
                "missing", name=name, meaning=CARVE_KEYS[name].meaning
            )
    ways = [name for name in ("H_V_N_per_mm3", "results", "published") if name in values]
    choices = Message("Give H_V_N_per_mm3 and S_f_N_per_mm2, or results, or published")
    if not ways:
        raise ParameterError("no snow is given: H_V has no default. {choices}").tag("missing", choices=choices)
    if len(ways) > 1:
        raise ParameterError("the snow is given in two ways, {first} and {second}. {choices}").tag(
            "contradiction", first=ways[0], second=ways[1], choices=choices
        )
    if ways == ["H_V_N_per_mm3"] and "S_f_N_per_mm2" not in values and not rests:
        raise ParameterError(
            "S_f_N_per_mm2 is missing: a carved turn needs the failure shear stress S_f, which has no default. State "
            "it, or compute the ski at rest"
        ).tag("missing")
    if "site" in values and ways != ["results"]:
        raise ParameterError("site names one site of an analysed campaign and needs results. Remove it").tag(
            "contradiction"
        )


_SNOW: Final = {quantity.name: quantity for quantity in own_quantities(SnowProperties)}


SKI_FACTORS: Final = {
    "sidecut_factor": SIDECUT,
    "width_factor": "width_mm",
    "EI_factor": "EI_N_m2",
    "GJ_factor": "GJ_N_m2",
}
"""Inputs that change the ski, with the factors of `SkiEdit`."""


def _ski_factor(name: str, what: Message) -> Quantity:
    """Input that multiplies a quantity of the ski."""
    meaning = Message("factor of the ski's {what}", what=what)
    return Quantity(name, meaning, label=meaning, lowest=0.01, highest=100.0, origin="the ski's own")


@dataclass(frozen=True, slots=True, kw_only=True)
class CarveQuestion(Declared):
    """One question about a ski in snow, in the units in the names; None for inputs that are not stated."""

    ski: Annotated[str, Quantity("ski", "a ski of the catalogue, or the path of a ski file")]
    edge_angle_deg: Annotated[
        float,
        Quantity("edge_angle_deg", "angle ϑ of the base under the boot to the snow surface"),
        Label(Message("edge angle"), symbol="ϑ"),
        Allowed(
            0.0,
            round(math.degrees(GREATEST_EDGE_ANGLE), 9),
            origin="at 90° the side force of a balanced turn has no bound",
        ),
    ]
    load_N: Annotated[
        float,
        Quantity("load_N", "force on this ski along the snow normal, at the boot"),
        Label(Message("load")),
        Allowed(0.0, above=True),
    ]
    H_V_N_per_mm3: Annotated[float | None, _SNOW["H_V_N_per_mm3"]] = None
    S_f_N_per_mm2: Annotated[
        float | None, replace(_SNOW["S_f_N_per_mm2"], meaning=Message("failure shear stress S_f; not needed at rest"))
    ] = None
    results: Annotated[str | None, _SNOW["results"]] = None
    site: Annotated[str | None, _SNOW["site"]] = None
    published: Annotated[str | None, _SNOW["published"]] = None
    unloading_ratio: Annotated[
        float | None,
        Quantity(
            "unloading_ratio",
            "k_u/H_V: 1 is elastic snow, inf rigid-plastic snow (computed as 1000); plays no part at rest",
            symbol="$k_u/H_V$",
            example="--unloading-ratio 10 (1 elastic, inf rigid-plastic)",
        ),
        Allowed(1.0, infinite=True, origin="not published: a parameter"),
    ] = None
    moment_Nm: Annotated[
        float,
        Quantity(
            "moment_Nm",
            "boot moment about the cross axis (see moment_balance), positive where it presses the tip down",
            origin="load at the boot",
        ),
        Label(Message("boot moment")),
    ] = 0.0
    moment_balance: Annotated[
        Literal["boot", "free"],
        Quantity(
            "moment_balance",
            "boot: that moment balances the load alone, about the horizontal, and the boot holds what the side "
            "force does besides; free: it is about the ski's own cross axis, and all that the boot holds there",
            origin="choice: boot and skier lean as they must; plays no part at rest",
        ),
    ] = "boot"
    clamp_length_m: Annotated[
        float,
        Quantity("clamp_length_m", "length of ski that boot and binding keep straight"),
        Label(Message("clamp length")),
        Allowed(0.0, origin="choice: about a boot's sole"),
    ] = CLAMP_LENGTH
    footprint_stiffness_N_per_mm2: Annotated[
        float | None,
        Quantity(
            "footprint_stiffness_N_per_mm2",
            "stiffness of boot and binding under each metre of the clamp length, against bending; default: rigid",
        ),
        Label(Message("footprint stiffness")),
        Allowed(0.0, 1e4, above=True),
    ] = None
    side_force_bending: Annotated[
        bool,
        Quantity(
            "side_force_bending",
            "whether the side force, too, bends and twists the ski",
            origin="exact: its part normal to the base is sin ϑ of it",
        ),
    ] = True
    side_force_spread: Annotated[
        Literal["depth", "base-reaction"],
        Quantity(
            "side_force_spread",
            "how the side force goes along the edge: as its depth, or as the snow's force on the base",
            origin="choice: as the shear strength of the paper, S_f e; not measured",
        ),
    ] = "depth"
    groove: Annotated[
        Literal["edge", "path"],
        Quantity(
            "groove",
            "edge: the groove is under the edge of the afterbody; path: on the circle of the turn",
            origin="choice: a carved track is one edge wide",
        ),
    ] = "edge"
    twist: Annotated[
        bool,
        Quantity("twist", "whether the ski twists, or keeps its edge angle everywhere", origin="exact: skis twist"),
    ] = True
    elements: Annotated[
        int,
        Quantity("elements", "finite elements over the whole ski"),
        Label(Message("elements")),
        Allowed(4, MOST_ELEMENTS, origin="choice: 1 cm each"),
    ] = ELEMENTS
    at_rest: Annotated[
        bool,
        Quantity(
            "at_rest",
            "the ski is set down on virgin snow, without side force, instead of carving",
            origin="the question is the turn",
        ),
    ] = False

    sidecut_factor: Annotated[float, _ski_factor("sidecut_factor", Message("width beyond that of the waist"))] = 1.0
    width_factor: Annotated[float, _ski_factor("width_factor", Message("width"))] = 1.0
    EI_factor: Annotated[float, _ski_factor("EI_factor", Message("bending stiffness EI"))] = 1.0
    GJ_factor: Annotated[float, _ski_factor("GJ_factor", Message("torsional stiffness GJ"))] = 1.0

    def changed(self, ski: Ski) -> Ski:
        """Ski with the factors of the question applied; the ski itself if all factors are 1."""
        factors = {column: float(getattr(self, name)) for name, column in SKI_FACTORS.items()}
        if all(factor == 1.0 for factor in factors.values()):
            return ski
        return edited_ski(ski, SkiEdit(edit_stations(ski), factors), name=ski.name, source=ski.source)

    def as_dict(self) -> dict[str, Any]:
        """The inputs under their names."""
        return asdict(self)

    @property
    def arguments(self) -> dict[str, Any]:
        """The inputs as arguments of `carve`, in SI; only some of them matter at rest."""
        stiffness = self.footprint_stiffness_N_per_mm2
        names = ("side_force_bending", "side_force_spread", "groove", "moment_balance", "twist", "elements")
        return {
            "edge_angle": self.edge_angle_deg * DEGREE,
            "load": self.load_N,
            "moment": self.moment_Nm,
            "unloading_ratio": self.unloading_ratio,
            "clamp_length": self.clamp_length_m,
            "footprint_stiffness": None if stiffness is None else stiffness * N_PER_MM2,
            **{name: getattr(self, name) for name in names},
        }


CARVE_KEYS: Final = {key.name: key for key in own_quantities(CarveQuestion)}
"""By name, in the order of tables."""


USUAL_LOADS_N: Final = (20.0, 5000.0)
"""Loads beyond it look like another unit: 2 kg of ski, and six times the weight of a heavy skier (assumption)."""


def require_clamp(ski: Ski, clamp_length_m: float) -> None:
    """Reject a clamp that is too long for the ski, with the longest allowed value.

    Raises ParameterError: half of the clamp reaches beyond the tip or the tail.
    """
    most = 2.0 * min(float(ski.station[0]), -float(ski.station[-1]))
    if clamp_length_m >= most:
        raise ParameterError(
            "clamp_length_m (--clamp-length-m) is {clamp_length:g}; the ski {name} allows less than {most:.3g} m: "
            "write --clamp-length-m 0"
        ).tag("out_of_range", clamp_length=clamp_length_m, name=ski.name, most=most)


def implausible_values(question: CarveQuestion) -> tuple[Message, ...]:
    """Warnings about numbers that look as if they were in another unit."""
    texts = []
    degrees = in_degrees_if_radians(question.edge_angle_deg)
    if degrees is not None:
        words = template("{name} is {value:g}: that looks like radians. If it is, write {degrees:.4g}")
        texts.append(Message(words, name="edge_angle_deg", value=question.edge_angle_deg, degrees=degrees))
    low, high = USUAL_LOADS_N
    if not low <= question.load_N <= high:
        words = template("load_N is {load:g}: is it in kg or kN? It is read as newtons (80 kg weigh 785 N)")
        texts.append(Message(words, load=question.load_N))
    hardness = question.H_V_N_per_mm3
    if hardness is not None and hardness > GREATEST_LIKELY_HARDNESS:
        words = template("H_V_N_per_mm3 is {hardness:g}: is it in N/m³? If it is, write {converted:.4g}")
        texts.append(Message(words, hardness=hardness, converted=hardness / N_PER_MM3))
    return tuple(texts)
