"""Two oracles for a released pin, with the stored answers of one oracle."""
