"""The paper's three validation stages, run anew: expected against measured, row by row."""
