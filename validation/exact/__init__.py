"""The wave models beside the exact wave."""
