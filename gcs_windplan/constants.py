"""Numbers with an authority, each named on its line."""

WGS84_SEMI_MAJOR_AXIS = 6378137.0  # [m] NGA.STND.0036 (WGS 84), table 3.1
WGS84_FLATTENING = 1 / 298.257223563  # NGA.STND.0036 (WGS 84), table 3.1
STANDARD_GRAVITY = 9.80665  # [m/s²] 3rd CGPM (1901)
NAUTICAL_MILE = 1852.0  # [m] BIPM SI brochure, 8th edition, table 8
KNOT = NAUTICAL_MILE / 3600  # [m/s] BIPM SI brochure, 8th edition, table 8
INTERNATIONAL_FOOT = 0.3048  # [m] NIST SP 811, B.6
US_SURVEY_FOOT = 1200 / 3937  # [m] NIST SP 811, B.6
STATUTE_MILE = 1609.344  # [m] NIST SP 811, B.6
DRY_AIR = 287.0597  # [J/kg/K] gas constant; ECMWF IFS documentation, part IV, chapter 12
WATER_VAPOUR = 461.5250  # [J/kg/K] gas constant; the same
