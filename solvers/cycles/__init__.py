"""Limit cycles: how large a self-excited whirl grows [theory: whirl, eq. 21-31].

`cycles` is the entry: the branches of circular whirls of finite size over speed, for any rotor in isotropic
supports. `wave` is a layer whose wave stands in the whirl's frame, `balance` the rotor that has to agree with
it, `branch` follows both, `floquet` tells what a small disturbance does, `estimate` needs no layer at all.
"""
