"""One drive: as data, its motion, the numbers of the motion, many motions at once."""
