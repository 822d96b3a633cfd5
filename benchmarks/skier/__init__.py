"""How often a skier in skidded turns succeeds, from disturbed starts on snow that it does not know."""
