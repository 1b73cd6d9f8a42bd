fn encode_roughness(r: f32) -> f32 { return r * r; }
fn decode_roughness(e: f32) -> f32 { return sqrt(e); }
