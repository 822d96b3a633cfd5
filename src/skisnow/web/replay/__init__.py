"""The replay in the lab: its addresses, and the measured tracks beside a run. The replay itself is `skisnow.replay`."""
