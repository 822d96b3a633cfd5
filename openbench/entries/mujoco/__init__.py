"""skisnow's contact library in MuJoCo: MuJoCo moves the body, the library says what the snow does to it."""
