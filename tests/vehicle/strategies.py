"""Power models as Hypothesis draws them, within what small aircraft are."""

from hypothesis import strategies as st

from gcs_windplan.vehicle import FixedWing, Multirotor, RotaryWing

masses = st.floats(0.5, 25)
densities = st.floats(0.6, 1.4)
airspeeds = st.floats(0, 40)
climbs = st.floats(0, 10)
rotary_wings = st.builds(
    RotaryWing,
    mass=masses,
    disc_area=st.floats(0.1, 3),
    solidity=st.floats(0.02, 0.2),
    tip_speed=st.floats(50, 200),
    blade_drag=st.floats(0.005, 0.05),
    induced_excess=st.floats(0, 0.5),
    body_drag=st.floats(0, 2),
    efficiency=st.floats(0.3, 1),
)
multirotors = st.builds(
    Multirotor,
    mass=masses,
    k1=st.floats(0.5, 3),
    k2=st.floats(0.2, 100),
    c2=st.floats(0, 2),
    c4=st.floats(0.005, 0.2),
    c5=st.floats(0, 0.05),
    density=densities,
)
fixed_wings = st.builds(
    FixedWing,
    mass=masses,
    wing_area=st.floats(0.1, 2),
    aspect_ratio=st.floats(3, 25),
    oswald=st.floats(0.5, 1),
    parasite_drag=st.floats(0.01, 0.1),
    efficiency=st.floats(0.2, 1),
)
