"""A scene: one machine in a TOML file, read, checked and frozen in SI units."""
