"""How tiles move with the numbers of a design: derivatives of outlines, areas and lengths, in closed form."""
