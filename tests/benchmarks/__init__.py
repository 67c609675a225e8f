"""Speed, memory and quality beside peers. They print tables and assert that all agree, never how fast they are.

Run by `python -m pytest tests/benchmarks`; the tests proper leave them out.
"""
