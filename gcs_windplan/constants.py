"""Numbers with an authority, each named on its line."""

WGS84_SEMI_MAJOR_AXIS = 6378137.0  # [m] NGA.STND.0036 (WGS 84), table 3.1
WGS84_FLATTENING = 1 / 298.257223563  # NGA.STND.0036 (WGS 84), table 3.1
STANDARD_GRAVITY = 9.80665  # [m/s²] 3rd CGPM (1901)
DRY_AIR = 287.0597  # [J/kg/K] gas constant; ECMWF IFS documentation, part IV, chapter 12
WATER_VAPOUR = 461.5250  # [J/kg/K] gas constant; the same
