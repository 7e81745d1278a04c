"""Published cases: numbers from the open literature, and what pindrive computes for each."""
