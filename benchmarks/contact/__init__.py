"""The compiled contact: what its constants move."""
