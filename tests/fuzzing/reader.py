"""A reader of files under test: its sound files, its mutations, and the functions of skisnow that it runs."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from random import Random

from .texts import Mutation

Files = Mapping[str, bytes]
Seal = Callable[[bytes], bytes]
LARGEST_BYTES = 10_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Reader:
    """One way in which bytes of a user come into skisnow.

    Attributes
    ----------
    name
        The reader's name, also the first word of its seeds.
    target
        Path, below the case's folder, of the file that is mutated.
    files
        Makes the sound files, by their paths.
    read
        Reads the case's folder as a user would, and uses what it gives.
    mutations
        Mutations of the target's format.
    covers
        Functions of skisnow that open the file, as ``module:qualified.name`` without the leading ``skisnow.``.
    seal
        Repairs checksums, after half of the mutations.
    needs
        Packages that skisnow does without.
    """

    name: str
    target: str
    files: Callable[[], Files]
    read: Callable[[Path], object]
    mutations: tuple[Mutation, ...]
    covers: tuple[str, ...]
    seal: Seal | None = None
    needs: tuple[str, ...] = ()

    @property
    def is_ready(self) -> bool:
        """True if all packages that it needs are installed."""
        return all(find_spec(name) for name in self.needs)

    def mutated(self, number: int) -> bytes:
        """The target of a case: the same bytes for the same number."""
        rng = Random(f"{self.name} {number}")
        data = self.files()[self.target]
        for _ in range(rng.choice((1, 1, 1, 2, 2, 3))):
            data = rng.choice(self.mutations)(rng, data)
        if self.seal is not None and rng.random() < 0.5:
            data = self.seal(data)
        return data[:LARGEST_BYTES]

    def lay(self, folder: Path, target: bytes | None = None) -> None:
        """Write a case's files; `target` replaces the sound one."""
        for name, content in self.files().items():
            place = folder / name
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(target if name == self.target and target is not None else content)


def single_file(
    name: str,
    content: bytes | Callable[[], Files],
    read: Callable[[Path], object],
    mutations: tuple[Mutation, ...],
    *covers: str,
    target: str = "",
    beside: Files | None = None,
    needs: tuple[str, ...] = (),
) -> Reader:
    """Reader that takes the path of its target, called like the reader unless `target` is given."""
    file = target or name
    files = content if callable(content) else lambda: {file: content, **(beside or {})}
    return Reader(
        name=name, target=file, files=files, read=lambda folder: read(folder / file), mutations=mutations,
        covers=covers, needs=needs,
    )  # fmt: skip
