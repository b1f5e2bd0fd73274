"""Limit cycles: how large a self-excited whirl grows [theory: whirl, eq. 21-31].

`cycles` is the entry: branches of circular whirls of finite size over speed, for any rotor in isotropic
supports. `wave` is a layer whose wave stands in the whirl's frame, `balance` the rotor with it, `branch`
follows both, `floquet` is their stability, `estimate` needs no layer at all.
"""
