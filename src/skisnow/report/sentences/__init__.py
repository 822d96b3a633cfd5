"""What a report says in words, from the results alone; every sentence is HTML with the users' names escaped."""
