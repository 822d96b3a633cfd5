"""What each constant of the code moves: collected from the sources, varied in one build, told in a page."""
