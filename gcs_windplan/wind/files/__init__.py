"""The readers of forecast files, one a format: which sheets a file holds, and how to read one."""
