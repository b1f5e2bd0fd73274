"""The net: every command on every example scene, held against answers that are kept in this folder.

`python -m tests.net check` after a change that must not change an answer; `python -m tests.net keep` after
one that should.
"""
