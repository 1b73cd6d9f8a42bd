"""The kinds of codecs: the inputs and outputs of their functions, and the catalogue's results for values."""
