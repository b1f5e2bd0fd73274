"""How it is solved: the liquid alone, the dry rotor, both; `liquid_model` is what a liquid answers."""
