"""History of a contact, to go back to it in this process or from bytes in another one."""

from __future__ import annotations

from collections.abc import Callable

from .._support.errors import ParameterError
from .._support.units import Facts, Shown
from ..compiled import core


class ContactState(Shown):
    """The history of a contact at one moment; `skisnow.SnowContact.state` gives it, ``restore`` takes it.

    It can be pickled and copied. A state that comes from bytes serves any contact of equal runners and spacing in equal
    snow, on any machine; laws of yours in Python are not in the bytes: make sure that they are the same.

    See Also
    --------
    skisnow.SnowContact

    References
    ----------
    * The page docs/how-to/contact.md.
    """

    __slots__ = ("_compiled", "_kept", "_to_bytes")

    def __init__(self, compiled: core.State | None, kept: bytes | None, to_bytes: Callable[[], bytes] | None) -> None:
        self._compiled, self._kept, self._to_bytes = compiled, kept, to_bytes

    @classmethod
    def of(cls, contact: core.Contact) -> ContactState:
        """Present state of a compiled contact."""
        state = contact.state()
        return cls(state, None, lambda: contact.bytes_of(state))

    @classmethod
    def from_bytes(cls, data: bytes) -> ContactState:
        """A state that `to_bytes` has written.

        Raises
        ------
        ParameterError
            They are damaged, not complete, or of another version of the form.
        """
        try:
            core.check_bytes(bytes(data))
        except ValueError as error:
            raise ParameterError("ContactState: {error}").tag("invalid_state", error=error) from error
        return cls(None, bytes(data), None)

    def to_bytes(self) -> bytes:
        """Bytes of the whole state, with the tracks in its snow.

        Raises
        ------
        ParameterError
            Tracks of the state were forgotten when an earlier one was restored.
        """
        if self._kept is None:
            assert self._to_bytes is not None
            try:
                return self._to_bytes()
            except ValueError as error:
                raise ParameterError("ContactState: {error}").tag("invalid_state", error=error) from error
        return self._kept

    def restore_in(self, contact: core.Contact) -> None:
        """Reset a compiled contact to this state; ValueError if the state is of another contact."""
        if self._compiled is not None:
            contact.restore(self._compiled)
        else:
            contact.take_bytes(self.to_bytes())

    def __reduce__(self) -> tuple[Callable[[bytes], ContactState], tuple[bytes]]:
        """Pickled as its bytes."""
        return ContactState.from_bytes, (self.to_bytes(),)

    def _repr_facts(self) -> Facts:
        """Title with the size of the stored state in bytes, or that it is of this process."""
        return Facts("of this process" if self._kept is None else f"of {len(self._kept)} bytes")
