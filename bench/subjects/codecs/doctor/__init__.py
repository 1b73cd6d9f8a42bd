"""The search for likely mistakes in a user's encoder and decoder, which are tried separately and together."""
