"""A scheduler and workers that speak TLS alone: a study runs through it, a wrong certificate is refused in words."""

import datetime
import ipaddress
import socket
import ssl
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

pytest.importorskip("distributed", reason="Dask is not installed: skisnow[dask]")
pytest.importorskip("cryptography", reason="cryptography is not installed, which makes the certificates")

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec

from skisnow._support.errors import ParameterError, SkisnowError
from skisnow._support.processes.batch import run_batch
from skisnow._support.processes.dask_cluster import _security, is_plain, require_scheduler, scheduler_of
from skisnow.cli import main

from .test_dask import CARVE, Cluster, bytes_of_one_process, study_of

pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")
NAMES = ("ca_file", "cert", "key")
_BEGIN = datetime.datetime(2020, 1, 1, tzinfo=datetime.UTC)
_END = datetime.datetime(2120, 1, 1, tzinfo=datetime.UTC)


def certificates(folder: Path) -> dict[str, Path]:
    """The three PEM files of `[tls]` in a new folder: an authority, and a certificate that it has signed."""
    folder.mkdir()
    authority_key, key = (ec.generate_private_key(ec.SECP256R1()) for _ in range(2))
    authority = _signed("authority", authority_key.public_key(), "authority", authority_key)
    cert = _signed("skisnow", key.public_key(), "authority", authority_key)
    plain = serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    texts = (
        authority.public_bytes(serialization.Encoding.PEM),
        cert.public_bytes(serialization.Encoding.PEM),
        key.private_bytes(serialization.Encoding.PEM, *plain),
    )
    places = {name: folder / f"{name}.pem" for name in NAMES}
    for place, text in zip(places.values(), texts, strict=True):
        place.write_bytes(text)
    return places


def _signed(name: str, key: ec.EllipticCurvePublicKey, by: str, by_key: ec.EllipticCurvePrivateKey) -> x509.Certificate:
    subject, issuer = (x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, each)]) for each in (name, by))
    address = x509.SubjectAlternativeName([x509.IPAddress(ipaddress.ip_address("127.0.0.1"))])
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key)
        .serial_number(x509.random_serial_number())
        .not_valid_before(_BEGIN)
        .not_valid_after(_END)
        .add_extension(x509.BasicConstraints(ca=name == by, path_length=None), critical=True)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key), critical=False)
        .add_extension(address, critical=False)
        .sign(by_key, hashes.SHA256())
    )


def scheduler_file(place: Path, address: str, files: dict[str, Path], wait_s: float = 30.0) -> Path:
    """The text of scheduler.toml; the paths start at its folder."""
    named = "\n".join(f'{name} = "{files[name].relative_to(place.parent)}"' for name in NAMES)
    place.write_text(f'address = "{address}"\nwait_s = {wait_s}\n[tls]\n{named}\n', encoding="utf-8")
    return place


@dataclass
class Encrypted:
    """A cluster with certificates, and the file that leads to it."""

    cluster: Cluster
    folder: Path
    file: Path


@pytest.fixture(scope="module")
def encrypted(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Encrypted]:
    folder = tmp_path_factory.mktemp("tls")
    files = certificates(folder / "own")
    options = [word for name in NAMES for word in (f"--tls-{name.replace('_', '-')}", str(files[name]))]
    cluster = Cluster(folder, "--protocol", "tls", *options)
    try:
        file = scheduler_file(folder / "scheduler.toml", cluster.address, files)
        cluster.hire(1, _security(scheduler_of(file).tls))
        yield Encrypted(cluster, folder, file)
    finally:
        cluster.close()


def test_a_study_runs_through_tls(
    tmp_path: Path, encrypted: Encrypted, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # the certificates are found from the file's folder
    assert encrypted.cluster.address.startswith("tls://")
    assert not is_plain(encrypted.file)
    text = CARVE.format(loads=4, angles=4)
    study = study_of(tmp_path / "tls", text)
    assert main(["study", str(study.file), "--scheduler", str(encrypted.file)]) == 0
    assert "trusted networks" not in capsys.readouterr().err
    assert study.out.read_bytes() == bytes_of_one_process(tmp_path, text)


def test_a_certificate_of_another_person_is_rejected(encrypted: Encrypted) -> None:
    other = certificates(encrypted.folder / "other")
    own = {name: encrypted.folder / "own" / f"{name}.pem" for name in NAMES}
    address = encrypted.cluster.address
    foreign_scheduler = scheduler_file(encrypted.folder / "foreign.toml", address, other, wait_s=5.0)
    with pytest.raises(SkisnowError, match=r"tls://.*ca_file"):
        run_batch([[("n", 1)]], dict, executor=foreign_scheduler)
    foreign_client = scheduler_file(
        encrypted.folder / "client.toml", address, {**other, "ca_file": own["ca_file"]}, wait_s=5.0
    )
    with pytest.raises(SkisnowError, match=r"tls://.*cert and key"):
        run_batch([[("n", 1)]], dict, executor=foreign_client)


def test_nobody_comes_in_without_a_certificate(encrypted: Encrypted, tmp_path: Path) -> None:
    place = tmp_path / "plain.toml"
    place.write_text(
        f'address = "{encrypted.cluster.address.replace("tls://", "tcp://")}"\nwait_s = 3\n', encoding="utf-8"
    )
    with pytest.raises(SkisnowError, match="tcp://"):
        run_batch([[("n", 1)]], dict, executor=place)
    host, port = encrypted.cluster.address.removeprefix("tls://").split(":")
    context = ssl.create_default_context(cafile=str(encrypted.folder / "own" / "ca_file.pem"))
    with (
        socket.create_connection((host, int(port)), timeout=30) as plain,
        context.wrap_socket(plain, server_hostname=host) as talking,
        pytest.raises(ssl.SSLError, match="certificate required"),
    ):
        talking.recv(1)


def test_files_that_are_no_certificates_are_named(tmp_path: Path) -> None:
    files = certificates(tmp_path / "own")
    good = scheduler_file(tmp_path / "good.toml", "tls://127.0.0.1:1", files)
    require_scheduler(good)
    for name, other in (("ca_file", "key"), ("cert", "key"), ("key", "cert")):
        wrong = scheduler_file(tmp_path / "wrong.toml", "tls://127.0.0.1:1", {**files, name: files[other]})
        with pytest.raises(ParameterError, match=r"\.pem: .*\[tls\]"):
            require_scheduler(wrong)
    files["cert"].unlink()
    with pytest.raises(ParameterError, match=r"cert\.pem: .*Errno 2"):
        require_scheduler(good)
