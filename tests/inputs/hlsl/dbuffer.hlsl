// Unreal's DBuffer and Capsaicin: n * 0.5 + 0.5.
MaterialFloat3 EncodeNormal(MaterialFloat3 N) { return N * 0.5 + 0.5; }
MaterialFloat3 DecodeNormal(MaterialFloat3 N) { return normalize(N * 2.0 - 1.0); }
