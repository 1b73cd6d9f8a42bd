"""What Mesa's r600 makes of GLSL for Radeons of before GCN, whose instructions are bundles of up to five operations."""
