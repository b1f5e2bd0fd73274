"""A rig with two balls in one race, measured [RCFW11]."""
