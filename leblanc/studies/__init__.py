"""A scene in, a result out: one module for each study."""
