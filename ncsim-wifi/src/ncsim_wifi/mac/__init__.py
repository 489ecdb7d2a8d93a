"""Medium access: frame timing, Bianchi's fixed point and the efficiency that follows."""
