"""What `validation.exact` keeps, measured: `python -m tests.exact`."""
