"""Is it true: published cases, errata of the sources, measured rigs."""
