float encode_roughness(float x, float range) { return (x / range) * (x / range); }
float decode_roughness(float e, float range) { return sqrt(e) * range; }
