"""A stand-in vehicle with ArduPilot's or PX4's mission rules, so that an upload can be tried with nothing installed."""
