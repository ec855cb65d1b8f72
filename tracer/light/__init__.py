"""Where light comes from: area lights, and the choice among them."""
