"""skisnow on the cases: its contact, its dynamics and its carve, each as a user has them."""
