"""The only access to compilers: checked texts, and the compilers on this machine."""
