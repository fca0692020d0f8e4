"""How smooth a movement is: the two measures that movement science settled on, of a speed in time.

SPARC, the arc length of the speed's spectrum: S. Balasubramanian, A. Melendez-Calderon, A. Roby-Brami & E. Burdet, "On
the analysis of movement smoothness", J. NeuroEng. Rehabil. 12:112 (2015). Log dimensionless jerk: N. Hogan & D.
Sternad, "Sensitivity of smoothness measures to movement duration, amplitude, and arrests", J. Motor Behav. 41 (2009).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

WINDOW = 2.0  # seconds: both measures depend on how long a movement is watched
_STEP = 0.05  # seconds from one window to the next: they begin anywhere in a stride
_HIGHEST, _LEAST = 10.0, 0.05  # Hz; part of the spectrum's top below which it ends
_PADDING = 4  # powers of two by which the spectrum is refined
_LOW_PASS = 8.0  # Hz, as recorded markers are smoothed


@dataclass(frozen=True)
class Smoothness:
    """The more negative the rougher; means over windows of 2 s."""

    sparc: float
    jerk: float  # log dimensionless jerk


def smoothness(places: Floats, rate: float) -> Smoothness | None:
    """Of a point (N, 3) seen `rate` times a second, at least 2 s; None where it stays where it is."""
    # Takes a tenth of a start to import.
    from scipy.signal import butter, sosfiltfilt

    filtered = sosfiltfilt(butter(2, _LOW_PASS, fs=rate, output="sos"), places, axis=0)
    speed = rate * np.linalg.norm(np.diff(filtered, axis=0), axis=1)
    size, step = round(WINDOW * rate), round(_STEP * rate)
    windows = [speed[first : first + size] for first in range(0, len(speed) - size + 1, step)]
    moving = [window for window in windows if window.max() > 1e-3]
    if not moving:
        return None
    return Smoothness(
        float(np.mean([sparc(window, rate) for window in moving])),
        float(np.mean([log_dimensionless_jerk(window, rate) for window in moving])),
    )


def sparc(speed: Floats, rate: float) -> float:
    """The spectral arc length of a speed (N,)."""
    size = 2 ** (int(np.ceil(np.log2(len(speed)))) + _PADDING)
    spectrum = np.abs(np.fft.rfft(speed, size))
    frequencies = np.fft.rfftfreq(size, 1.0 / rate)
    spectrum, frequencies = spectrum[frequencies <= _HIGHEST] / spectrum.max(), frequencies[frequencies <= _HIGHEST]
    loud = np.flatnonzero(spectrum >= _LEAST)
    spectrum, frequencies = spectrum[loud[0] : loud[-1] + 1], frequencies[loud[0] : loud[-1] + 1]
    steps = np.diff(frequencies) / (frequencies[-1] - frequencies[0])
    return -float(np.hypot(steps, np.diff(spectrum)).sum())


def log_dimensionless_jerk(speed: Floats, rate: float) -> float:
    """-ln(T^3 / peak^2 * the integral of the speed's second derivative squared), of a speed (N,)."""
    jerk = rate**2 * np.diff(speed, 2)
    duration = len(speed) / rate
    return -float(np.log(duration**3 / speed.max() ** 2 * (jerk @ jerk) / rate + 1e-12))
