"""Floats of 32 bits, as MAVLink carries them."""

from __future__ import annotations

import math
import struct


def single(number: float) -> float:
    """The number as a float of 32 bits; one too large for it is infinite."""
    try:
        return float(struct.unpack("<f", struct.pack("<f", number))[0])
    except OverflowError:
        return math.copysign(math.inf, number)


def same_float(one: float, other: float) -> bool:
    """Whether both are the same float of 32 bits, or both NaN."""
    return (math.isnan(one) and math.isnan(other)) or single(one) == single(other)


def float_text(number: float) -> str:
    """The shortest decimal that is the same float of 32 bits."""
    texts = (f"{number:.{digits}g}" for digits in range(6, 10))
    return next((text for text in texts if same_float(float(text), number)), f"{number:.9g}")


def is_cut(sent: float, held: float, step: float) -> bool:
    """Whether a number was cut towards zero to whole steps; the float on the wire may lie just below a step."""
    if not (math.isfinite(sent) and math.isfinite(held)):
        return False
    noise = math.ulp(sent) * 2.0**30  # twice the distance of the floats of 32 bits around it
    in_steps = abs(held - round(held / step) * step) <= noise
    gone = math.copysign(1.0, sent) * (sent - held)
    return in_steps and sent * held >= 0 and -noise <= gone < step + noise
