"""The wire: MAVLink messages, and missions that go to a vehicle and come back."""
