half EncodeRoughness(half roughness) { return roughness * roughness; }
half DecodeRoughness(half e) { return sqrt(e); }
