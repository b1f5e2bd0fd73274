"""What a spindle unit and its rolling bearings answer."""
