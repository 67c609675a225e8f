"""The readers of forecast files, one a format: which fields a file holds, and how to read one."""
