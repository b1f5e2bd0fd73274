"""The page of `leblanc app`: its state without a browser, and all of it in one."""
