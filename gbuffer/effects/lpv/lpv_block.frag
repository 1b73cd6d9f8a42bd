#version 430
// A surfel's blocking potential, added to its corner.

flat in vec4 potential;
out vec4 blockers;

void main() { blockers = potential; }
