// Wicked Engine's normals of the visibility buffer: the octahedral map in [0, 1], with halves.
half2 oct_wrap(half2 v) { return (1 - abs(v.yx)) * (v.xy >= 0 ? 1 : -1); }

half2 encode_oct(half3 n) {
    n /= dot(abs(n), 1);
    n.xy = n.z >= 0 ? n.xy : oct_wrap(n.xy);
    return n.xy * 0.5 + 0.5;
}

half3 decode_oct(half2 e) {
    e = e * 2 - 1;
    half3 n = half3(e, 1 - abs(e.x) - abs(e.y));
    half t = saturate(-n.z);
    n.xy += n.xy >= 0 ? -t : t;
    return normalize(n);
}
