"""Files that are read and written: device files, the kinds of files, safe replacement."""
