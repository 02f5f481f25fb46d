"""What acts from outside the bodies' mutual gravity: other masses on known paths, tides, radiation, a user's force."""
