"""Powers, ratios and rates: the paper's physical layer, one function per equation."""
