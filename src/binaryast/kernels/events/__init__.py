"""What events watch, and how a loop of steps looks for them."""
