"""Row of one parameter, the same for all twins."""

from skisnow.identification import Identified

from .kept import number


def interval_row(each: Identified, truth: float) -> dict[str, str]:
    """Truth, best value, ends of the 95 % interval, in the key's unit."""
    low, high = each.interval or (None, None)
    key = each.parameter.key
    values = {"true": truth, "found": each.value, "low": low, "high": high}
    return {f"{key} {name}": number(value) for name, value in values.items()}
