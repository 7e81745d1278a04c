"""Two oracles for a released pin, and the cases that one of them has answered."""
