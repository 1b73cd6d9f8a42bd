// Functions that need no view-space position, given one: SHORT_ENCODE and SHORT_DECODE are their names.
#ifdef SHORT_ENCODE
CODE viewed_encode(vec3 n, vec3 view) { return SHORT_ENCODE(n); }
#endif
#ifdef SHORT_DECODE
vec3 viewed_decode(CODE e, vec3 view) { return SHORT_DECODE(e); }
#endif

// The encoding in other axes: OWN_ENCODE and OWN_DECODE are its functions, AXES and AXES_BACK the order of components,
// and AXES_SIGN is -1 where the opposite direction is encoded.
#ifdef AXES
CODE turned_encode(vec3 n, vec3 view) { return OWN_ENCODE(AXES_SIGN * n.AXES, AXES_SIGN * view.AXES); }
vec3 turned_decode(CODE e, vec3 view) { return AXES_SIGN * OWN_DECODE(e, AXES_SIGN * view.AXES).AXES_BACK; }
#endif
