"""Published cases: what a source prints, what the package computes, the difference and a verdict."""
