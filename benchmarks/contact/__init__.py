"""The compiled contact: what an evaluation costs."""
