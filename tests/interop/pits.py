"""A snow pit with everything that a snow pit may have; numbers that two decimals in the file's units hold."""

import numpy as np

from skisnow.campaign.snow_pit import DepthTemperature, ForceProfile, LayerDensity, PlateValue, SnowLayer, SnowPit


def full_pit() -> SnowPit:
    return SnowPit(
        name="Hang <Süd> & Ost",
        time="2026-02-03T09:10:00+01:00",
        observer="A. Müller",
        comment="groomed at night",
        country="AT",
        region="Tirol",
        latitude_deg=47.25,
        longitude_deg=11.01,
        elevation=2014.0,
        aspect="NE",
        slope_angle_deg=17.0,
        snow_height=1.25,
        air_temperature_C=-4.5,
        layers=(
            SnowLayer(0.0, 0.12, "K-", "MFpc", 0.75e-3, "machine-made"),
            SnowLayer(0.12, 0.3, "P+", "RGsr", 0.5e-3),
            SnowLayer(0.42, None, "4F", "FCxr", hardness_bottom="P"),
        ),
        densities=(LayerDensity(0.0, 512.5, 0.1), LayerDensity(0.2, 430.0, 0.1), LayerDensity(0.5, 350.0)),
        temperatures=(DepthTemperature(0.0, -7.25), DepthTemperature(0.1, -5.5), DepthTemperature(0.5, 0.0)),
        forces=(ForceProfile("SnowMicroPen", np.array([0.0, 0.001, 0.002]), np.array([0.5, 3.25, 12.0])),),
        snow_hardness=PlateValue(2.5, 12, (1.75, 3.5)),
        failure_shear_stress=PlateValue(0.15, 9),
    )
