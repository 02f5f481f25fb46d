"""The oracles: codes and closed forms that share nothing with the package, given the package's G and starts."""
