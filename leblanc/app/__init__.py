"""The page of `leblanc app`: a machine as fields and sliders beside its answer.

`fields` makes the form from the scene's models, `machine` is the file while it is changed, `live` answers
it, `jobs` start what takes its time, `state` is all that a page shows; trame is known by `page` alone.
"""
