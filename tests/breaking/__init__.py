"""`python -m tests.breaking` computes what `validation.breaking` keeps."""
