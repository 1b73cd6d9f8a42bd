"""The only way to a compiler: texts that are judged, and the compilers of this machine."""
