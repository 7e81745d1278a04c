"""The quantities that go in or come out: names, units, bounds, sources; and text with units."""
