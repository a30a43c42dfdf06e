"""Headlines of chapters 4 and 5: the theorem, the paper's drive."""
