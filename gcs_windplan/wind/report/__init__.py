"""What is in forecast files, for people: an inventory, the wind at one place, a map."""
