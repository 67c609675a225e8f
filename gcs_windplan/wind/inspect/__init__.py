"""What is in forecast files: an inventory, whether a mission can be planned in them, the wind at a place, a map."""
