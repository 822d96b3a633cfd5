"""A short run in every format of receivers: 12 points, 8 m/s, southwards, over a gentle bend."""

from math import cos, sin
from typing import Final

from tests.track.readers.receivers import FIT_EPOCH, fit_file, nav_pvt, sentence

_COUNT: Final = 12
_FIT_BEGIN: Final = 1672156274 - FIT_EPOCH
_POSITION_TAIL: Final = "1  12   0.0080   0.0060   0.0150   0.0010  -0.0020   0.0030   0.00   99.9"


def _lat(i: int) -> float:
    return 47.0 - 7.2e-5 * i


def _lon(i: int) -> float:
    return 11.0 + 2e-5 * sin(0.3 * i)


def _height(i: int) -> float:
    return 1500.0 - 1.4 * i


def _local() -> str:
    rows = (f"{0.2 * i:.1f},{1.6 * i:.3f},{2 * cos(0.3 * i):.3f},{-0.3 * i:.2f},8.0" for i in range(_COUNT))
    return "time_s,x_m,y_m,z_m,speed_m_per_s\n" + "\n".join(rows) + "\n"


def _earth() -> str:
    rows = (f"2022-12-27T15:51:{14 + i}Z,{_lat(i):.7f},{_lon(i):.7f},{_height(i)},8.1" for i in range(_COUNT))
    return "time,lat,lon,alt_m,speed_mps\n" + "\n".join(rows) + "\n"


def _gpx() -> str:
    points = [
        f'<trkpt lat="{_lat(i):.7f}" lon="{_lon(i):.7f}"><ele>{_height(i)}</ele><time>2022-12-27T15:51:{14 + i}Z</time>'
        f"<extensions><gpxtpx:TrackPointExtension><gpxtpx:speed>8.1</gpxtpx:speed></gpxtpx:TrackPointExtension></extensions>"
        "</trkpt>"
        for i in range(_COUNT)
    ]
    head = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<gpx version="1.1" creator="a watch" '
        'xmlns="http://www.topografix.com/GPX/1/1" '
        'xmlns:gpxtpx="http://www.garmin.com/xmlschemas/TrackPointExtension/v2">'
    )
    halves = ("".join(points[:9]), "".join(points[9:]))
    return f"{head}<trk><name>x</name>{''.join(f'<trkseg>{half}</trkseg>' for half in halves)}</trk></gpx>\n"


def _fit() -> bytes:
    scale = 2**31 / 180
    return fit_file(
        [
            {
                "timestamp": _FIT_BEGIN + i,
                "position_lat": round(_lat(i) * scale),
                "position_long": round(_lon(i) * scale),
                "altitude": round((_height(i) + 500) * 5),
                "speed": 8100,
                "distance": 810 * i,
            }
            for i in range(_COUNT)
        ]
    )


def _nmea() -> bytes:
    def minutes(degrees: float, width: int) -> str:
        return f"{int(degrees):0{width}d}{60 * (degrees % 1):010.7f}"

    sentences = []
    for i in range(_COUNT):
        place = f"{minutes(_lat(i), 2)},N,{minutes(_lon(i), 3)},E"
        sentences.append(f"GNRMC,1551{14 + i}.00,A,{place},15.7,180.0,271222,,,A")
        sentences.append(f"GNGGA,1551{14 + i}.00,{place},4,12,0.6,{_height(i):.1f},M,47.9,M,,")
        sentences.append("GNVTG,180.0,T,,M,15.7,N,29.2,K,A")
    return b"".join(map(sentence, sentences))


def _ubx() -> bytes:
    return b"".join(
        nav_pvt(
            second=14 + i, lat=round(_lat(i) * 1e7), lon=round(_lon(i) * 1e7), height=round(_height(i) * 1e3),
            time_of_week=229_892_000 + 1000 * i, velocity=(-8000, 100, 1400),
        )
        for i in range(_COUNT)
    )  # fmt: skip


def _pos() -> str:
    head = (
        "% program : RTKPOST\n% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix)\n%  GPST  latitude(deg) longitude(deg)"
        "  height(m)   Q  ns   sdn(m)   sde(m)   sdu(m)  sdne(m)  sdeu(m)  sdun(m) age(s)  ratio\n"
    )
    return head + "".join(
        f"2022/12/27 15:51:{14 + i}.000   {_lat(i):.9f}   {_lon(i):.9f}  {_height(i):.4f}   {_POSITION_TAIL}\n"
        for i in range(_COUNT)
    )


FILES: Final = {
    "local.csv": _local().encode(),
    "semicolons.csv": _local().replace(",", ";").replace(".", ",").encode(),
    "earth.csv": _earth().encode(),
    "watch.gpx": _gpx().encode(),
    "watch.fit": _fit(),
    "receiver.nmea": _nmea(),
    "receiver.ubx": _ubx(),
    "llh.pos": _pos().encode(),
}
