"""Workers on other computers, by Dask: a scheduler that runs, or a batch system that starts workers."""

from __future__ import annotations

import inspect
import ssl
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from ..environment import load_certificate, needed
from ..errors import ParameterError, SkisnowError, nearest
from ..messages import Message, template
from ..user_files import read_toml
from .crews import LOST, Crew, GivenCrew, PointFunction, lost_workers_message

BATCH_SYSTEMS: Final = {
    "slurm": "SLURMCluster",
    "pbs": "PBSCluster",
    "sge": "SGECluster",
    "lsf": "LSFCluster",
    "oar": "OARCluster",
    "moab": "MoabCluster",
    "htcondor": "HTCondorCluster",
}
"""By the name of their table: the class of dask-jobqueue."""
TLS_KEYS: Final = ("ca_file", "cert", "key", "ciphers")
_ANY: Final = inspect.Parameter.VAR_KEYWORD
_NOT_LOADED: Final = ("Can't get attribute", "deserializ")
"""Texts of Python and Dask where a function is not there."""
WAIT_S: Final = 30.0
"""Time-out (s) for the answer of a scheduler (default of the file's key)."""
AWAY_S: Final = 10.0
"""Time (s) that a scheduler may be unreachable during the work."""
CHUNK_S: Final = 1.0
"""Work (s) that is handed over at once (from one piece to the next a worker takes some 10 ms, and
some 50 where its cores are wanted by others)."""
COUNTED_EVERY_S: Final = 1.0
"""Interval (s) between counts of the workers, which come and go."""


@dataclass(frozen=True, slots=True)
class SchedulerFile:
    """Contents of a TOML file for a scheduler.

    Attributes
    ----------
    address
        Address of a running scheduler; None: a batch system starts workers.
    wait_s
        How long it may take to answer.
    tls
        Files of certificates.
    system, options
        The batch system, and the arguments of its class of dask-jobqueue.
    jobs
        Number of jobs.
    """

    address: str | None = None
    wait_s: float = WAIT_S
    tls: Mapping[str, str] | None = None
    system: str | None = None
    options: Mapping[str, Any] | None = None
    jobs: int = 1


def require_scheduler(scheduler: str | Path) -> None:
    """Raise an error for an invalid scheduler before the work begins.

    Raises
    ------
    ParameterError
        Dask is not installed, the address, the file or a certificate cannot be read, or an option of the batch system
        is unknown (code ``unknown_option``).
    """
    settings = scheduler_of(scheduler)
    _distributed()
    _require_certificates(settings.tls or {})
    if settings.system is not None:
        _require_options(settings.system, settings.options or {})


def _require_options(system: str, options: Mapping[str, Any]) -> None:
    """Reject an option that the batch system's class of dask-jobqueue does not have."""
    cluster = getattr(_jobqueue(), BATCH_SYSTEMS[system])
    classes = (*cluster.__mro__, *cluster.job_cls.__mro__)
    parameters = [
        inspect.signature(vars(cls)["__init__"]).parameters
        for cls in classes
        if cls is not object and "__init__" in vars(cls)
    ]
    names = {
        name for signature in parameters for name, parameter in signature.items() if parameter.kind is not _ANY
    } - {"self"}
    for name in options:
        if name not in names:
            raise ParameterError(
                f"{system}.{name} is not an option of dask-jobqueue. {nearest(name, sorted(names))}",
                code="unknown_option",
            )


def is_plain(scheduler: str | Path) -> bool:
    """True if data travel unencrypted, and any client that reaches the scheduler can run programs."""
    return not _is_encrypted(scheduler_of(scheduler))


def _is_encrypted(settings: SchedulerFile) -> bool:
    return bool(settings.tls) or (settings.address or "").startswith(("tls://", "wss://"))


def scheduler_of(scheduler: str | Path) -> SchedulerFile:
    """Settings of an address or a TOML file.

    Raises
    ------
    ParameterError
        It is not a scheduler, or a key in it is unknown or of the wrong kind.
    """
    if isinstance(scheduler, str) and "://" in scheduler:
        return SchedulerFile(address=scheduler)
    if Path(scheduler).suffix.lower() != ".toml":
        raise ParameterError(
            "The scheduler is {scheduler!r}. It must be an address such as tcp://host:8786, a file that ends in "
            ".toml, threads or processes.",
            code="unknown_executor",
            scheduler=scheduler,
        )
    try:
        return _of_table(read_toml(scheduler), Path(scheduler).parent)
    except ParameterError as error:
        raise (error if str(scheduler) in str(error) else error.at(scheduler)) from error


def _of_table(table: Mapping[str, Any], folder: Path) -> SchedulerFile:
    keys = ("address", "wait_s", "tls", *BATCH_SYSTEMS)
    for key in table:
        if key not in keys:
            raise ParameterError(
                "{key} is not a key of a scheduler. {allowed}", code="unknown_key", key=key, allowed=nearest(key, keys)
            )
    places = [key for key in table if key == "address" or key in BATCH_SYSTEMS]
    if len(places) != 1:
        tables = [f"[{name}]" for name in BATCH_SYSTEMS]
        problem = (
            Message("A scheduler has an address or one of {tables}, not {given} together.", tables=tables, given=places)
            if places
            else Message("A scheduler needs an address or one of {tables}.", tables=tables)
        )
        raise ParameterError(problem, code="scheduler_place")
    (place,) = places
    wait = table.get("wait_s", WAIT_S)
    if isinstance(wait, bool) or not isinstance(wait, int | float) or not wait > 0:
        raise ParameterError("wait_s is {wait!r}. It must be a number above 0.", code="out_of_range", wait=wait)
    tls = _tls(table.get("tls"), folder)
    if place == "address":
        if not isinstance(table[place], str) or "://" not in table[place]:
            raise ParameterError(
                'address is {value!r}. It must be a text such as "tcp://host:8786".',
                code="wrong_kind",
                value=table[place],
            )
        return SchedulerFile(table[place], wait, tls)
    return _of_batch_system(place, table[place], wait, tls)


def _of_batch_system(system: str, entries: object, wait: float, tls: Mapping[str, str] | None) -> SchedulerFile:
    if not isinstance(entries, dict):
        raise ParameterError(
            "{key} is {value!r}. It must be a table that begins with the line [{key}].",
            code="wrong_kind",
            key=system,
            value=entries,
        )
    options = dict(entries)
    jobs = options.pop("jobs", 1)
    if isinstance(jobs, bool) or not isinstance(jobs, int) or jobs < 1:
        raise ParameterError(
            "{system}.jobs is {jobs!r}. It must be a whole number of 1 or more.",
            code="out_of_range",
            system=system,
            jobs=jobs,
        )
    for name in ("cores", "memory"):
        if name not in options:
            raise ParameterError(
                '{system}.{name} is missing. It is the size of one job, such as cores = 16, memory = "32GB".',
                code="missing_key",
                system=system,
                name=name,
            )
    # one process for each core: see docs/decisions.md
    return SchedulerFile(None, wait, tls, system, {"processes": options["cores"], **options}, jobs)


def _tls(entries: object, folder: Path) -> Mapping[str, str] | None:
    """The table of certificates, its paths from the folder that they start at."""
    if entries is None:
        return None
    if not isinstance(entries, dict):
        raise ParameterError(
            "{key} is {value!r}. It must be a table that begins with the line [{key}].",
            code="wrong_kind",
            key="tls",
            value=entries,
        )
    for key, value in entries.items():
        if key not in TLS_KEYS:
            raise ParameterError(
                "tls.{key} is not a key of a scheduler. {allowed}",
                code="unknown_key",
                key=key,
                allowed=nearest(key, TLS_KEYS),
            )
        if not isinstance(value, str):
            raise ParameterError(_MEANINGS.get(key, _PATH), code="wrong_kind", key=key, value=value)
    return {key: value if key == "ciphers" else str(folder / value) for key, value in entries.items()}


_PATH: Final = template("tls.{key} is {value!r}. It must be the path of a PEM file.")
_MEANINGS: Final = {"ciphers": template("tls.{key} is {value!r}. It must be a text, as OpenSSL writes ciphers.")}


def crew_of_scheduler(scheduler: str | Path, function: PointFunction) -> Crew:
    """Workers of a scheduler. At the end the connection is closed and requested jobs are cancelled.

    Raises
    ------
    ParameterError
        As of `require_scheduler`.
    SkisnowError
        It does not answer.
    """
    require_scheduler(scheduler)
    settings = scheduler_of(scheduler)
    distributed = _distributed()
    if settings.system is not None:
        cluster = batch_cluster(settings)
        cluster.scale(jobs=settings.jobs)
        client = distributed.Client(cluster)
        return crew_of_client(client, function, close=lambda: _closed(client, cluster))
    try:
        client = distributed.Client(
            settings.address, timeout=settings.wait_s, security=_security(settings.tls), name="skisnow"
        )
    except (OSError, ValueError, TypeError) as error:
        raise SkisnowError(_unanswered(settings, error), code="no_scheduler") from error
    return crew_of_client(client, function, close=lambda: _closed(client))


def _require_certificates(tls: Mapping[str, str]) -> None:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    what = ""
    try:
        if what := tls.get("ca_file", ""):
            context.load_verify_locations(what)
        if what := tls.get("cert", ""):
            load_certificate(context, what, tls.get("key"))
    except (OSError, ssl.SSLError, ValueError) as error:
        raise ParameterError(
            "{file}: no certificate can be read ({error}). [tls] needs PEM files: ca_file, the authority; cert and "
            "key, a certificate that it signed and its private key.",
            code="no_certificate",
            file=what,
            error=error,
        ) from error


def _unanswered(settings: SchedulerFile, error: Exception) -> Message:
    if _is_encrypted(settings):
        return Message(
            "No connection to the scheduler at {address} ({error}). It uses certificates. Check that it runs, that "
            "ca_file signed its certificate, and that it accepts cert and key of [tls].",
            address=settings.address,
            error=error,
        )
    return Message(
        "No scheduler answers at {address} ({error}). Start one with `dask scheduler`, and workers with "
        "`dask worker`; both print their address.",
        address=settings.address,
        error=error,
    )


def batch_cluster(settings: SchedulerFile) -> Any:
    """A cluster of dask-jobqueue, which has no workers yet.

    Raises
    ------
    ParameterError
        Its class does not have an option.
    """
    jobqueue = _jobqueue()
    security = _security(settings.tls)
    options = {**(settings.options or {}), **({} if security is None else {"security": security, "protocol": "tls://"})}
    try:
        return getattr(jobqueue, BATCH_SYSTEMS[settings.system or ""])(**options)
    except (TypeError, ValueError) as error:
        raise ParameterError(
            "[{system}]: dask-jobqueue rejects it: {error}",
            code="rejected_by_dask",
            system=settings.system,
            error=error,
        ) from error


def crew_of_client(client: Any, function: PointFunction, close: Callable[[], None] | None = None) -> Crew:
    """Workers of a Dask client."""
    return _DaskCrew(function, client, close)


class _DaskCrew(GivenCrew):
    """The scheduler gives a chunk of a worker that was lost to another one."""

    chunk_s = CHUNK_S

    def __init__(self, function: PointFunction, client: Any, close: Callable[[], None] | None) -> None:
        super().__init__(function, client.get_executor(pure=False), self._threads, close)
        self._client = client
        self._counted, self._at, self._last_seen = 1, -COUNTED_EVERY_S, time.monotonic()

    def _threads(self) -> int:
        if time.monotonic() - self._at > COUNTED_EVERY_S:
            with suppress(Exception):  # it does not answer: `require_alive` says so after a while
                self._counted = sum(self._client.nthreads(callback_timeout=COUNTED_EVERY_S).values())
            self._at = time.monotonic()
        return self._counted

    def require_alive(self) -> None:
        """Refuse to wait for a scheduler that has been away for long; one that breaks for a moment comes back."""
        if self._client.status == "running":
            self._last_seen = time.monotonic()
        elif time.monotonic() - self._last_seen > AWAY_S or self._client.status == "closed":
            raise SkisnowError(lost_workers_message(), code=LOST)

    def told(self, error: Exception) -> Message | None:
        """Explanation of an error of Dask."""
        if isinstance(error, ImportError) or any(word in str(error) for word in _NOT_LOADED):
            return Message(
                "A worker cannot load the computation ({error}). Install the same skisnow there.", error=error
            )
        if type(error).__module__.startswith("distributed"):
            return Message("Dask gave up: {kind}: {error}.", kind=type(error).__name__, error=error)
        return super().told(error)


def _closed(client: Any, cluster: Any = None) -> None:
    client.close()
    if cluster is not None:
        cluster.close()


def _security(tls: Mapping[str, str] | None) -> Any:
    """Certificates for all three parts; None: Dask's own configuration."""
    if not tls:
        return None
    named = {"tls_ca_file": tls.get("ca_file"), "tls_ciphers": tls.get("ciphers")}
    for part in ("client", "scheduler", "worker"):
        named |= {f"tls_{part}_cert": tls.get("cert"), f"tls_{part}_key": tls.get("key")}
    stated = {name: value for name, value in named.items() if value is not None}
    return _distributed().Security(require_encryption=True, **stated)


def _distributed() -> Any:
    return needed("distributed", extra="dask", what=Message("A scheduler"))


def _jobqueue() -> Any:
    return needed("dask_jobqueue", extra="dask", what=Message("A batch system"))
