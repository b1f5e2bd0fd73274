"""Fill sweep of a real top loader: its logs, one assumed machine for all seven fills, and the verdict."""
