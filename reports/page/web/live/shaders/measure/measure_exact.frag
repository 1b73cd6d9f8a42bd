// The numbers of each normal's code before they are stored, as bits.
out uvec4 bits;

void main() { bits = floatBitsToUint(PADDED(encoded())); }
