"""USD files, by UsdSkel."""
