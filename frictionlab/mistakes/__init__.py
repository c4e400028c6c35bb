"""What is wrong with given values: one sentence for each mistake, in a study and in Python."""
