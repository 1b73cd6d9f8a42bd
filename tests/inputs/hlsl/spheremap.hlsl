// The spheremap of Torque3D and vanilla Skyrim: Lambert's azimuthal projection, about z.
half2 Encode(half3 n) {
    half f = sqrt(8.0 * n.z + 8.0);
    return n.xy / max(f, 0.001) + 0.5;
}

half3 Decode(half2 enc) {
    half2 fenc = enc * 4.0 - 2.0;
    half f = dot(fenc, fenc);
    half g = sqrt(max(1.0 - f / 4.0, 0.0));
    return half3(fenc * g, 1.0 - f / 2.0);
}
