"""Drone missions that know the wind and the ground: plan, push, review.

Read and write

    read_mission    a mission file (.yaml) to be planned         Mission, which can be made without a file
    read_items      a ground station's file (.plan, .waypoints)  ReadMission: MissionItems and what was repaired
    read_airframe   an airframe's file                           Airframe: Vehicle, Battery and power
    read_forecast   winds in GRIB, NetCDF, Open-Meteo's answers  Forecast
    write           a plan, items or an assessment, by the file's name

Plan and judge

    plan            a mission's route                            Plan
    compare         a plan for each cost                         Plan, Plan, ...
    departures      when to fly                                  Departure, Departure, ...
    review          a mission against terrain, wind and limits   Assessment and its Finding
    check           what a firmware makes of it, by its rules    Check
    diff            whether two missions are the same            MissionDiff

A vehicle

    push            a mission, read back and compared            Transfer
    pull            what a vehicle holds                         Transfer
    clear           delete that, and look whether it is gone     Transfer

Values: a mission's Place (GeoPoint, or LocalPoint in a LocalFrame), Area, ObstacleFile, Limits, CostChoice,
WindProfile, Uniform or Roadmap, Export; of what flies it Home and MissionItem. Long work tells its Progress and stops
by a CancelToken.

Errors: WindplanError above all. InputError (with a Problem for each thing that is wrong): MissionFileError,
TerrainError, WindError, FormatError, AddressError, RequestError. NoRouteError and its
BatteryError. LinkError and its RefusedError. CancelledError.

The names are fetched when they are first asked for: the command's help must not wait for compilers and file readers.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
